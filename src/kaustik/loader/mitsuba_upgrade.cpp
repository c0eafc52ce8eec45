#include "kaustik/loader/mitsuba_upgrade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "kaustik/base/snake_case.h"
#include "kaustik/loader/mitsuba_values.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::mitsuba {
namespace {

/// In files of versions before `until` a type or a name was called `old_name`. A type may imply a
/// distribution of facets.
struct TypeName {
  Version until;
  std::string_view family, old_name, name, distribution = {};
};
/// Of dialects of any version.
constexpr Version any_version = {1'000'000, 0, 0};
constexpr TypeName type_names[] = {
    {any_version, "bsdf", "bump", "bumpmap"},
    {first_of_mitsuba_0_3, "bsdf", "lambertian", "diffuse"},
    {first_of_mitsuba_0_3, "bsdf", "roughmetal", "roughconductor"},
    {first_of_mitsuba_0_3, "bsdf", "roughglass", "roughdielectric"},
    {first_of_mitsuba_0_3, "bsdf", "microfacet", "roughplastic"},
    {first_of_mitsuba_0_3, "bsdf", "composite", "mixturebsdf"},
    {first_of_mitsuba_0_3, "texture", "exrtexture", "bitmap"},
    {first_of_mitsuba_0_3, "texture", "ldrtexture", "bitmap"},
    {first_with_snake_case, "texture", "vertexcolors", "mesh_attribute"},
    {any_version, "bsdf", "roughconductorggx", "roughconductor", "ggx"},
    {any_version, "bsdf", "roughdielectricggx", "roughdielectric", "ggx"},
    {any_version, "bsdf", "roughplasticggx", "roughplastic", "ggx"},
    {any_version, "bsdf", "mirror", "conductor"},
    {any_version, "bsdf", "blinn", "phong"},
    {any_version, "bsdf", "blinn_microfacet", "phong"},
    {any_version, "bsdf", "disneybsdf", "principled"},
    {any_version, "bsdf", "disneydiffuse", "principled"},
    {any_version, "bsdf", "disneymetal", "principled"},
    {any_version, "bsdf", "disneyglass", "principled"},
    {any_version, "bsdf", "mixture", "mixturebsdf"},
    {any_version, "phase", "rayleigh_polarized", "rayleigh"},
    {any_version, "volume", "grid", "gridvolume"}};

/// Of an object of this family and, unless it is empty, of this type; in snake case.
struct PropertyName {
  Version until;
  std::string_view family, type, old_name, name;
};
constexpr PropertyName property_names[] = {
    {first_with_snake_case, "bsdf", "diffuse", "diffuse_reflectance", "reflectance"},
    {first_of_mitsuba_0_4, "emitter", "area", "intensity", "radiance"},
    {first_of_mitsuba_0_4, "emitter", "constant", "intensity", "radiance"},
    {first_of_mitsuba_0_4, "emitter", "directional", "intensity", "irradiance"},
    {first_of_mitsuba_0_4, "emitter", "envmap", "intensity_scale", "scale"},
    {first_of_mitsuba_0_4, "medium", "", "density_multiplier", "scale"},
    {first_with_snake_case, "medium", "heterogeneous", "density", "sigma_t"},
    {any_version, "medium", "homogeneous", "density", "scale"},
    {any_version, "medium", "", "density_scale", "scale"},
    {first_of_mitsuba_0_4, "sensor", "", "focus_depth", "focus_distance"},
    {first_of_mitsuba_0_3, "bsdf", "", "alpha_b", "alpha"},
    {first_of_mitsuba_0_3, "bsdf", "", "alpha_x", "alpha_u"},
    {first_of_mitsuba_0_3, "bsdf", "", "alpha_y", "alpha_v"},
    {first_of_mitsuba_0_3, "texture", "checkerboard", "bright_color", "color0"},
    {first_of_mitsuba_0_3, "texture", "checkerboard", "dark_color", "color1"},
    {first_of_mitsuba_0_3, "texture", "gridtexture", "bright_color", "color0"},
    {first_of_mitsuba_0_3, "texture", "gridtexture", "dark_color", "color1"},
    {first_of_mitsuba_0_3, "bsdf", "roughconductor", "ior", "eta"},
    {first_of_mitsuba_0_3, "medium", "", "size_multiplier", "scale"},
    {any_version, "texture", "", "lambda_min", "wavelength_min"},
    {any_version, "texture", "", "lambda_max", "wavelength_max"},
    {first_of_mitsuba_0_3, "shape", "sphere", "inverted", "flip_normals"},
    {first_of_mitsuba_0_3, "shape", "cylinder", "p1", "p0"},
    {first_of_mitsuba_0_3, "shape", "cylinder", "p2", "p1"}};

std::string lower_case(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

const TypeName* row_of(const std::string& family, const std::string& type, Version version) {
  const std::string wanted = lower_case(type);
  for (const TypeName& row : type_names)
    if (version < row.until && family == row.family && wanted == row.old_name) return &row;
  return nullptr;
}

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

Version parse_version(std::string_view text) {
  int parts[3] = {0, 0, 0};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (int i = 0; i < 3; ++i) {
    const auto [next, error] = std::from_chars(at, end, parts[i]);
    const bool ends = next == end;
    if (error != std::errc{} || parts[i] < 0 || (!ends && (i == 2 || *next != '.')))
      throw BadValue(fmt::format("{} is not a version", in_quotes(text)),
                     "write three numbers, as in version=\"3.0.0\"");
    if (ends) break;
    at = next + 1;
  }
  return {parts[0], parts[1], parts[2]};
}

std::string upgraded_tag(const std::string& tag, Version version) {
  if (version >= first_with_snake_case) return tag;
  if (tag == "lookAt") return "lookat";
  if (tag == "luminaire") return "emitter";
  if (tag == "camera") return "sensor";
  return tag;
}

std::string upgraded_type(const std::string& family, const std::string& type, Version version) {
  if (const TypeName* row = row_of(family, type, version)) return std::string(row->name);
  // Mitsuba 0.6 does not tell upper from lower case.
  return version < first_with_snake_case ? lower_case(type) : type;
}

std::string upgraded_name(const std::string& name, const Object& parent, Version version) {
  const std::string snake =
      version < first_with_snake_case ? snake_case_from_camel_case(name) : name;
  for (const PropertyName& row : property_names)
    if (version < row.until && parent.family == row.family &&
        (row.type.empty() || parent.type == row.type) && snake == row.old_name)
      return std::string(row.name);
  return snake;
}

void upgrade_object(Object& object, const std::string& written_type, Version version,
                    Problems& problems) {
  const TypeName* row = row_of(object.family, written_type, version);
  if (row && !row->distribution.empty() && !has(object, "distribution"))
    object.properties.push_back({"distribution", std::string(row->distribution), object.place});
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
