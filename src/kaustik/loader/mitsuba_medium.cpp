#include "kaustik/loader/mitsuba_medium.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace kaustik::mitsuba {
namespace {

/// Of 0.6, on the coefficients of materials.
constexpr double material_scale = 100;
/// Scattering and absorption of the material "skin1" there.
constexpr Rgb skin_sigma_s{74, 88, 101}, skin_sigma_a{3.2, 17, 48};

bool gives(const Object& object, std::string_view name) {
  const auto is_it = [&](const auto& part) { return part.name == name; };
  return std::any_of(object.properties.begin(), object.properties.end(), is_it) ||
         std::any_of(object.children.begin(), object.children.end(), is_it);
}

void add_unless_given(Object& medium, const char* name, const Rgb& value) {
  if (!gives(medium, name)) medium.properties.push_back({name, value, medium.place});
}

Rgb sum(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
Rgb ratio(const Rgb& a, const Rgb& b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }

/// The name of a material does not tell upper from lower case there.
void use_material(Object& medium) {
  if (!gives(medium, "material"))
    medium.properties.push_back({"material", std::string("skin1"), medium.place});
  bool has_scale = false;
  for (Property& property : medium.properties) {
    if (auto* name = std::get_if<std::string>(&property.value); name && property.name == "material")
      for (char& c : *name) c = char(std::tolower(static_cast<unsigned char>(c)));
    if (property.name != "scale") continue;
    has_scale = true;
    if (auto* scale = std::get_if<double>(&property.value)) *scale *= material_scale;
  }
  if (!has_scale) medium.properties.push_back({"scale", material_scale, medium.place});
}

}  // namespace

void upgrade_medium(Object& object, Version version) {
  if (version >= first_with_snake_case || object.family != "medium" || object.type != "homogeneous")
    return;
  const bool by_parts = gives(object, "sigma_s") || gives(object, "sigma_a");
  const bool by_extinction = gives(object, "sigma_t") || gives(object, "albedo");
  if (gives(object, "material") || (!by_parts && !by_extinction)) {
    use_material(object);
  } else if (by_parts) {
    add_unless_given(object, "sigma_s", skin_sigma_s);
    add_unless_given(object, "sigma_a", skin_sigma_a);
  } else {
    const Rgb skin_sigma_t = sum(skin_sigma_s, skin_sigma_a);
    add_unless_given(object, "sigma_t", skin_sigma_t);
    add_unless_given(object, "albedo", ratio(skin_sigma_s, skin_sigma_t));
  }
}

}  // namespace kaustik::mitsuba
