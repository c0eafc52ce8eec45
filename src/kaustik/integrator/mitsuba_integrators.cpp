#include "kaustik/integrator/mitsuba_integrators.h"

#include "kaustik/integrator/integrator.h"
#include "kaustik/integrator/path_parameters.h"
#include "kaustik/photon/emission.h"

namespace kaustik {
namespace {

TypeInfo of_path(const std::string& name, std::vector<Parameter> more = {}) {
  TypeInfo info{"integrator",
                name,
                "Mitsuba's name of 'path', which follows paths through media, too.",
                {components_parameter(), max_depth_parameter(), rr_depth_parameter(),
                 ignored_parameter("hide_emitters", ParameterKind::boolean),
                 ignored_parameter("strict_normals", ParameterKind::boolean),
                 ignored_parameter("samples_per_pass", ParameterKind::integer)}};
  info.parameters.insert(info.parameters.end(), more.begin(), more.end());
  return info;
}

}  // namespace

const TypeInfo& volpath_info() {
  static const TypeInfo info = of_path("volpath");
  return info;
}

const TypeInfo& volpath_simple_info() {
  static const TypeInfo info = of_path("volpath_simple");
  return info;
}

const TypeInfo& volpathmis_info() {
  static const TypeInfo info =
      of_path("volpathmis", {ignored_parameter("use_spectral_mis", ParameterKind::boolean)});
  return info;
}

const TypeInfo& direct_info() {
  static const TypeInfo info{
      "integrator",
      "direct",
      "Mitsuba's name of 'path' with max_depth = 2: lamps, and what they light directly.",
      {components_parameter(), ignored_parameter("shading_samples", ParameterKind::integer),
       ignored_parameter("emitter_samples", ParameterKind::integer),
       ignored_parameter("bsdf_samples", ParameterKind::integer),
       ignored_parameter("hide_emitters", ParameterKind::boolean),
       ignored_parameter("strict_normals", ParameterKind::boolean),
       ignored_parameter("samples_per_pass", ParameterKind::integer)}};
  return info;
}

const TypeInfo& ptracer_info() {
  static const TypeInfo info{
      "integrator",
      "ptracer",
      "Mitsuba's name of 'lighttracer'.",
      {components_parameter(), max_depth_parameter(),
       ignored_parameter("rr_depth", ParameterKind::integer), aim_parameter(),
       ignored_parameter("samples_per_pass", ParameterKind::integer),
       ignored_parameter("hide_emitters", ParameterKind::boolean)}};
  return info;
}

}  // namespace kaustik
