#include "kaustik/loader/mitsuba_upgrade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "kaustik/loader/mitsuba_values.h"

namespace kaustik::mitsuba {
namespace {

constexpr Version first_with_snake_case = {2, 0, 0};

bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
char lower(char c) { return char(std::tolower(static_cast<unsigned char>(c))); }

/// toWorld becomes to_world, intIOR int_ior.
std::string snake_case_from_camel_case(const std::string& name) {
  std::string result;
  for (size_t i = 0; i < name.size(); ++i) {
    const bool starts_word = i > 0 && is_lower(name[i - 1]) && is_upper(name[i]);
    if (!starts_word) {
      result += name[i];
      continue;
    }
    result += '_';
    result += lower(name[i]);
    while (i + 1 < name.size() && is_upper(name[i + 1])) result += lower(name[++i]);
  }
  return result;
}

/// Removes a number from the properties.
std::optional<Property> take_number(Object& object, std::string_view name) {
  const auto at = std::find_if(
      object.properties.begin(), object.properties.end(),
      [&](const Property& p) { return p.name == name && std::holds_alternative<double>(p.value); });
  if (at == object.properties.end()) return std::nullopt;
  Property taken = std::move(*at);
  object.properties.erase(at);
  return taken;
}

}  // namespace

Version parse_version(std::string_view text) {
  int parts[3] = {0, 0, 0};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (int i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != '.')) at = end;
    const auto [next, error] = std::from_chars(at, end, parts[i]);
    if (error != std::errc{} || parts[i] < 0 || (i == 2 && next != end))
      throw BadValue(fmt::format("{} is not a version", in_quotes(text)),
                     "write three numbers, as in version=\"3.0.0\"");
    at = next;
  }
  return {parts[0], parts[1], parts[2]};
}

std::string upgraded_name(const std::string& name, const std::string& object_type,
                          Version version) {
  if (version >= first_with_snake_case) return name;
  const std::string snake = snake_case_from_camel_case(name);
  if (object_type == "diffuse" && snake == "diffuse_reflectance") return "reflectance";
  return snake;
}

std::string upgraded_tag(const std::string& tag, Version version) {
  if (version >= first_with_snake_case) return tag;
  if (tag == "lookAt") return "lookat";
  if (tag == "luminaire") return "emitter";
  if (tag == "camera") return "sensor";
  return tag;
}

void upgrade_conductor(Object& object, Version version) {
  if (version >= first_with_snake_case || object.family != "bsdf") return;
  if (object.type != "conductor" && object.type != "roughconductor") return;
  const auto tells_metal = [](const auto& part) {
    return part.name == "material" || part.name == "eta" || part.name == "k" ||
           part.name == "reflectance";
  };
  if (std::any_of(object.properties.begin(), object.properties.end(), tells_metal) ||
      std::any_of(object.children.begin(), object.children.end(), tells_metal))
    return;
  object.properties.push_back({"material", std::string("cu"), object.place});
}

void upgrade_texture_placement(Object& object, Version version, Problems& problems) {
  if (version >= first_with_snake_case) return;
  Vec3d offset(0, 0, 0), scale(1, 1, 1);
  Place place;
  const auto take = [&](std::string_view name, double& target) {
    if (const auto property = take_number(object, name)) {
      target = std::get<double>(property->value);
      if (!place.file) place = property->place;
    }
  };
  take("uoffset", offset.x);
  take("voffset", offset.y);
  take("uscale", scale.x);
  take("vscale", scale.y);
  if (!place.file) return;
  try {
    const Transform to_uv = Transform::scale(scale) * Transform::translate(offset);
    object.properties.push_back({"to_uv", to_uv, place});
  } catch (const std::invalid_argument&) {
    problems.add("the texture's uscale or vscale is too near to 0", "give another scale", place);
  }
}

}  // namespace kaustik::mitsuba
