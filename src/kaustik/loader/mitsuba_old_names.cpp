// Versions of Mitsuba's format, and what tags, types and names were called before.

#include <fmt/format.h>

#include <charconv>

#include "kaustik/base/snake_case.h"
#include "kaustik/loader/lower_case.h"
#include "kaustik/loader/mitsuba_upgrade.h"
#include "kaustik/loader/mitsuba_values.h"

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

const TypeName* row_of(const std::string& family, const std::string& type, Version version) {
  const std::string wanted = lower_case(type);
  for (const TypeName& row : type_names)
    if (version < row.until && family == row.family && wanted == row.old_name) return &row;
  return nullptr;
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

std::string implied_distribution(const std::string& family, const std::string& type,
                                 Version version) {
  const TypeName* row = row_of(family, type, version);
  return row ? std::string(row->distribution) : std::string();
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

}  // namespace kaustik::mitsuba
