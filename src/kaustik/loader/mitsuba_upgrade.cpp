#include "kaustik/loader/mitsuba_upgrade.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "kaustik/loader/lower_case.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::mitsuba {
namespace {

/// Removes a property with a value of type T.
template <typename T>
std::optional<Property> take(Object& object, std::string_view name) {
  const auto at = std::find_if(
      object.properties.begin(), object.properties.end(),
      [&](const Property& p) { return p.name == name && std::holds_alternative<T>(p.value); });
  if (at == object.properties.end()) return std::nullopt;
  Property taken = std::move(*at);
  object.properties.erase(at);
  return taken;
}

bool has(const Object& object, std::string_view name) {
  return std::any_of(object.properties.begin(), object.properties.end(),
                     [&](const Property& p) { return p.name == name; });
}

/// uoffset, voffset, uscale, vscale and uvscale become `to_uv`: scaled first, then moved, as 0.6
/// does it.
void upgrade_placement(Object& object, Problems& problems) {
  Vec3d offset(0, 0, 0), scale(1, 1, 1);
  Place place;
  const auto take_into = [&](std::string_view name, double& target) {
    if (const auto property = take<double>(object, name)) {
      target = std::get<double>(property->value);
      if (!place.file) place = property->place;
    }
  };
  take_into("uvscale", scale.x);
  scale.y = scale.x;
  take_into("uoffset", offset.x);
  take_into("voffset", offset.y);
  take_into("uscale", scale.x);
  take_into("vscale", scale.y);
  if (!place.file) return;
  try {
    const Transform to_uv =
        Transform::translate(offset) *
        Transform::collapsing({{scale.x, 0, 0, 0}, {0, scale.y, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}});
    object.properties.push_back({"to_uv", to_uv, place});
  } catch (const std::invalid_argument&) {
    problems.add("the texture's uscale or vscale is too near to 0", "give another scale", place);
  }
}

/// The present name of what a texture's property says.
std::string upgraded_choice(const std::string& name, const std::string& value) {
  struct Renamed {
    std::string_view property, before, now;
  };
  static constexpr Renamed table[] = {{"filter_type", "ewa", "bilinear"},
                                      {"filter_type", "trilinear", "bilinear"},
                                      {"wrap_mode", "black", "zero"},
                                      {"wrap_mode", "white", "one"}};
  for (const Renamed& row : table)
    if (name.starts_with(row.property) && value == row.before) return std::string(row.now);
  return value;
}

void upgrade_texture(Object& object, Problems& problems) {
  upgrade_placement(object, problems);
  if (object.family != "texture") return;
  for (Property& property : object.properties)
    if (auto* text = std::get_if<std::string>(&property.value))
      *text = upgraded_choice(property.name, *text);
  // It was called vertexcolors.
  if (object.type == "mesh_attribute" && !has(object, "name"))
    object.properties.push_back({"name", std::string("vertex_color"), object.place});
}

/// Cameras of Mitsuba 0.3 gave the field of view of the picture's smaller side, or of the larger
/// one.
void upgrade_field_of_view(Object& object) {
  if (object.family != "sensor" || object.type != "perspective" || has(object, "fov_axis")) return;
  const auto smaller = take<bool>(object, "map_smaller_side");
  const bool is_smaller = !smaller || std::get<bool>(smaller->value);
  object.properties.push_back({"fov_axis", std::string(is_smaller ? "smaller" : "larger"),
                               smaller ? smaller->place : object.place});
}

/// In 0.6 the file of a grid always told where it lies.
void upgrade_grid(Object& object) {
  if (object.family == "volume" && object.type == "gridvolume" && !has(object, "use_grid_bbox"))
    object.properties.push_back({"use_grid_bbox", true, object.place});
}

/// What no metal was named of was copper.
void upgrade_conductor(Object& object) {
  if (object.family != "bsdf" || (object.type != "conductor" && object.type != "roughconductor"))
    return;
  const auto tells_metal = [](const auto& part) {
    return part.name == "material" || part.name == "eta" || part.name == "k" ||
           part.name == "reflectance";
  };
  if (std::any_of(object.properties.begin(), object.properties.end(), tells_metal) ||
      std::any_of(object.children.begin(), object.children.end(), tells_metal))
    return;
  object.properties.push_back({"material", std::string("cu"), object.place});
}

/// Of a bsdf before 0.3, whose two reflectances are multiplied by amounts.
struct Amounts {
  std::string_view written_type;
  double diffuse, specular;  ///< reflectances where none is given
};
constexpr Amounts bsdfs_with_amounts[] = {
    {"phong", 0.5, 0.2}, {"ward", 0.5, 0.2}, {"microfacet", 0, 1}};

/// A texture that multiplies another one.
std::shared_ptr<Object> scaled_texture(const std::shared_ptr<Object>& texture, double factor) {
  const auto result = std::make_shared<Object>();
  result->family = "texture";
  result->type = "scale";
  result->place = texture->place;
  result->properties = {{"scale", factor, texture->place}};
  result->children = {{"value", texture}};
  return result;
}

void use_amount(Object& object, const std::string& share, double usual) {
  const std::string reflectance = share + "_reflectance", amount_name = share + "_amount";
  const auto is_it = [&](const auto& part) { return part.name == reflectance; };
  const auto child = std::find_if(object.children.begin(), object.children.end(), is_it);
  const bool is_child = child != object.children.end();
  if (is_child && !child->object) return;  // a reference that is still to be followed
  const auto given = take<double>(object, amount_name);
  const double amount = given ? std::get<double>(given->value) : 1;
  const auto value = std::find_if(object.properties.begin(), object.properties.end(), is_it);
  if (value != object.properties.end())
    multiply_value(value->value, amount);
  else if (!is_child)
    object.properties.push_back({reflectance, usual * amount, object.place});
  else if (amount != 1)
    child->object = scaled_texture(child->object, amount);
}

/// Before 0.3 a shape of which nothing else was said was matt, also one that is a lamp.
void give_bsdf(Object& object) {
  const auto tells = [](const Child& child) {
    return !child.object || child.object->family == "bsdf" || child.object->family == "medium" ||
           child.object->family == "shape";
  };
  if (object.family != "shape" ||
      std::any_of(object.children.begin(), object.children.end(), tells))
    return;
  const auto matt = std::make_shared<Object>();
  matt->family = "bsdf";
  matt->type = "diffuse";
  matt->place = object.place;
  object.children.push_back({"", matt});
}

/// Where Mitsuba 3 calls B and C of the paper A and B.
void upgrade_mitchell(Object& object) {
  if (object.family != "rfilter" || object.type != "mitchell" || !has(object, "A") ||
      has(object, "C"))
    return;
  for (Property& property : object.properties)
    if (property.name == "A" || property.name == "B") ++property.name[0];
}

/// Of lajolla, where metal and glass are types.
void upgrade_disney(Object& object, const std::string& written_type) {
  if (object.family != "bsdf" || object.type != "principled") return;
  const std::string type = lower_case(written_type);
  if (type == "disneymetal") object.properties.push_back({"metallic", 1.0, object.place});
  if (type == "disneyglass") object.properties.push_back({"spec_trans", 1.0, object.place});
}

}  // namespace

void upgrade_object(Object& object, const std::string& written_type, Version version,
                    Problems& problems) {
  const std::string distribution = implied_distribution(object.family, written_type, version);
  if (!distribution.empty() && !has(object, "distribution"))
    object.properties.push_back({"distribution", distribution, object.place});
  upgrade_disney(object, written_type);
  upgrade_mitchell(object);
  if (version < first_with_snake_case) {
    upgrade_texture(object, problems);
    upgrade_grid(object);
    if (written_type != "mirror") upgrade_conductor(object);
  }
  if (version < first_of_mitsuba_0_4) upgrade_field_of_view(object);
  if (version >= first_of_mitsuba_0_3) return;
  use_amounts(object, written_type);
  give_bsdf(object);
  if (object.family == "bsdf" && written_type == "mirror" && !has(object, "material"))
    object.properties.push_back({"material", std::string("cr"), object.place});
}

void use_amounts(Object& object, const std::string& written_type) {
  if (object.family != "bsdf") return;
  for (const Amounts& row : bsdfs_with_amounts)
    if (lower_case(written_type) == row.written_type) {
      use_amount(object, "diffuse", row.diffuse);
      use_amount(object, "specular", row.specular);
    }
}

bool loads_materials(const Object& object, Version version) {
  return version < first_with_snake_case && object.family == "shape" && object.type == "obj";
}

}  // namespace kaustik::mitsuba
