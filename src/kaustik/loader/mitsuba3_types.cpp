// What Mitsuba 3.7 has, by its plugins' documentation.

#include "kaustik/loader/mitsuba3_types.h"

#include <algorithm>
#include <map>
#include <set>

namespace kaustik {
namespace {

const std::map<std::string, std::set<std::string>>& types_of_mitsuba3() {
  static const std::map<std::string, std::set<std::string>> types = {
      {"shape",
       {"obj", "ply", "serialized", "rectangle", "cube", "sphere", "disk", "cylinder", "shapegroup",
        "instance", "merge", "sdfgrid", "bsplinecurve", "linearcurve", "ellipsoids",
        "ellipsoidsmesh"}},
      {"bsdf", {"diffuse",   "dielectric",     "roughdielectric", "thindielectric",
                "conductor", "roughconductor", "plastic",         "roughplastic",
                "pplastic",  "principled",     "principledthin",  "blendbsdf",
                "mask",      "twosided",       "bumpmap",         "normalmap",
                "null",      "hair",           "measured",        "measured_polarized",
                "polarizer", "retarder",       "circular"}},
      {"texture",
       {"bitmap", "checkerboard", "mesh_attribute", "volume", "blackbody", "d65", "regular",
        "irregular", "uniform", "srgb", "rawconstant"}},
      {"emitter",
       {"area", "directionalarea", "point", "spot", "projector", "directional", "constant",
        "envmap", "sunsky", "timed_sunsky"}},
      {"sensor",
       {"perspective", "thinlens", "orthographic", "irradiancemeter", "radiancemeter", "distant",
        "batch"}},
      {"film", {"hdrfilm", "specfilm"}},
      {"rfilter", {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"}},
      {"sampler", {"independent", "stratified", "multijitter", "orthogonal", "ldsampler"}},
      {"integrator",
       {"direct", "path", "volpath", "volpathmis", "prb", "prbvolpath", "ptracer", "aov", "depth",
        "moment"}},
      {"medium", {"homogeneous", "heterogeneous"}},
      {"phase", {"isotropic", "hg", "rayleigh", "tabphase", "blendphase", "sggx"}},
      {"volume", {"constvolume", "gridvolume"}}};
  return types;
}

const std::vector<LackingInMitsuba3>& lacking() {
  static const std::vector<LackingInMitsuba3> rows = {
      {"bsdf", "dielectric", "priority"},
      {"bsdf", "roughdielectric", "priority"},
      {"bsdf", "conductor", "reflectance"},
      {"bsdf", "conductor", "edge_tint"},
      {"bsdf", "conductor", "ext_eta"},
      {"bsdf", "roughconductor", "reflectance"},
      {"bsdf", "roughconductor", "edge_tint"},
      {"bsdf", "roughconductor", "ext_eta"},
      {"texture", "bitmap", "wrap_mode", {"zero", "one"}},
      {"texture", "bitmap", "wrap_mode_u"},
      {"texture", "bitmap", "wrap_mode_v"},
      {"texture", "blackbody", "scale"},
      {"emitter", "area", "scale"},
      {"emitter", "area", "two_sided"},
      {"emitter", "spot", "falloff"},
      {"emitter", "envmap", "gamma"},
      {"emitter", "envmap", "projection", {"equalarea"}},
      {"emitter", "", "attenuation"},
      {"emitter", "", "shadow_samples"},
      {"emitter", "", "visible"},
      {"film", "", "quantity"},
      {"integrator", "", "components"},
      {"medium", "homogeneous", "material"},
      {"sensor", "thinlens", "blades"},
      {"sensor", "thinlens", "blade_rotation"},
      {"sensor", "thinlens", "principal_point_offset_x"},
      {"sensor", "thinlens", "principal_point_offset_y"}};
  return rows;
}

}  // namespace

bool mitsuba3_has_type(const std::string& family, const std::string& type) {
  const auto known = types_of_mitsuba3().find(family);
  return known == types_of_mitsuba3().end() || known->second.contains(type);
}

const LackingInMitsuba3* lacking_in_mitsuba3(const std::string& family, const std::string& type,
                                             const Property& property) {
  for (const LackingInMitsuba3& row : lacking()) {
    if (row.family != family || row.name != property.name) continue;
    if (!row.type.empty() && row.type != type) continue;
    const auto* text = std::get_if<std::string>(&property.value);
    if (row.values.empty() || (text && std::ranges::find(row.values, *text) != row.values.end()))
      return &row;
  }
  return nullptr;
}

bool is_known_to_mitsuba3(const std::string& parameter) {
  static const std::set<std::string> names = {"accel",
                                              "aovs",
                                              "complex_sun",
                                              "component_format",
                                              "compensate",
                                              "file_format",
                                              "focus_distance",
                                              "format",
                                              "has_spectral_extinction",
                                              "max_value",
                                              "mis_compensation",
                                              "pixel_format",
                                              "raw",
                                              "rr_depth",
                                              "sample_border",
                                              "sample_emitters",
                                              "sample_visible",
                                              "sampling_weight",
                                              "seed",
                                              "shutter_close",
                                              "shutter_open",
                                              "srf",
                                              "to_world",
                                              "unbounded",
                                              "use_grid_bbox",
                                              "jitter",
                                              "flip_invalid_normals"};
  return names.contains(parameter);
}

bool may_be_left_out(const std::string& family, const std::string& parameter) {
  return family == "film" &&
         (parameter == "exposure" || parameter == "iso" || parameter == "layers");
}

}  // namespace kaustik
