#include "kaustik/photonmap/photon_map_settings.h"

#include <fmt/format.h>

#include "kaustik/photonmap/photon_map_parameters.h"
#include "kaustik/transport/integrator.h"
#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {
namespace {

/// Reads arguments through the preset: what the user gave wins, then the preset, then the table.
class PresetReader {
 public:
  explicit PresetReader(const Arguments& arguments)
      : arguments_(arguments), thesis_(arguments.text("preset") == "thesis") {}

  bool thesis() const { return thesis_; }
  int64_t integer(const char* name) const {
    const Value* value = preset(name);
    return value ? std::get<int64_t>(*value) : arguments_.integer(name);
  }
  float number(const char* name) const {
    const Value* value = preset(name);
    return float(value ? std::get<double>(*value) : arguments_.number(name));
  }
  bool boolean(const char* name) const {
    const Value* value = preset(name);
    return value ? std::get<bool>(*value) : arguments_.boolean(name);
  }
  std::string text(const char* name) const {
    const Value* value = preset(name);
    return value ? std::get<std::string>(*value) : arguments_.text(name);
  }

 private:
  const Value* preset(const std::string& name) const {
    if (!thesis_ || arguments_.given(name)) return nullptr;
    for (const PhotonMapParameter& row : photon_map_parameters())
      if (row.parameter.name == name) return row.in_thesis ? &*row.in_thesis : nullptr;
    return nullptr;
  }

  const Arguments& arguments_;
  bool thesis_;
};

std::vector<Parameter> parameters() {
  std::vector<Parameter> result;
  for (const PhotonMapParameter& row : photon_map_parameters()) result.push_back(row.parameter);
  result.push_back(hide_emitters_parameter());
  return result;
}

Kernel kernel_from(const std::string& name) {
  return name == "cone"       ? Kernel::cone
         : name == "constant" ? Kernel::constant
                              : Kernel::epanechnikov;
}

int events_from(int64_t level) { return level < 0 ? 1 << 20 : int(level); }

}  // namespace

const TypeInfo& PhotonMapSettings::info() {
  static const TypeInfo info{
      "integrator", "photonmap",
      "Two-pass photon mapping: caustics from photons, diffuse indirect light by gathering over a "
      "global photon map with an irradiance cache, specular light by tracing. Names in [] are from "
      "Schregle's thesis.",
      parameters()};
  return info;
}

PhotonMapSettings::PhotonMapSettings(const Arguments& arguments)
    : components(read_components(arguments)) {
  const PresetReader read(arguments);
  caustic.neighbors = int(read.integer("caustic_neighbors"));
  caustic.kernel = kernel_from(read.text("caustic_kernel"));
  caustic.cone_constant = read.number("caustic_filter");
  global.neighbors = int(read.integer("global_neighbors"));
  global.kernel = kernel_from(read.text("global_kernel"));
  visibility = read.boolean("visibility");
  light_pass.place_stride = uint32_t(read.integer("precompute_stride"));
  minimum_radiance = read.number("minimum_radiance");
  caustic_radius = read.number("caustic_radius");
  global_radius = read.number("global_radius");
  light_choice = read.text("light_sampling") == "all" ? LightChoice::all : LightChoice::one;
  light_samples = int(read.integer("light_samples"));
  shadow_photons = uint32_t(read.integer("shadow_photons"));
  shadows.neighbors = int(read.integer("shadow_neighbors"));
  shadows.accurate_levels = int(read.integer("shadow_accurate_levels"));
  shadow_radius = read.number("shadow_radius");
  diffuse_samples = int(read.integer("diffuse_samples"));
  gather_theta_cells = int(read.integer("importance_theta_cells"));
  gather_phi_cells = int(read.integer("importance_phi_cells"));
  importance_photons = int(read.integer("importance_photons"));
  // The thesis directs gather rays by the photons of its estimates.
  if (read.thesis() && !arguments.given("importance_photons") && global.neighbors > 0)
    importance_photons = global.neighbors;
  importance_by_average = read.text("importance_weight") == "average";
  importance_floor = read.number("importance_floor");
  const std::string sampling = read.text("specular_sampling");
  specular_sampling = sampling == "none"      ? SpecularSampling::none
                      : sampling == "perfect" ? SpecularSampling::perfect
                                              : SpecularSampling::importance;
  specular_samples = int(read.integer("specular_samples"));
  const std::string detail = read.text("level_of_detail");
  level_of_detail = detail == "none"     ? LevelOfDetail::none
                    : detail == "linear" ? LevelOfDetail::linear
                                         : LevelOfDetail::exponential;
  level_factor = read.number("level_factor");
  maximum_eye_level = int(read.integer("max_eye_level"));
  gathers = read.boolean("gather");
  count_specular_levels = read.boolean("count_specular_levels");
  samples_per_pass = uint32_t(read.integer("samples_per_pass"));
  cache = read.boolean("irradiance_cache");
  cache_settings.hemisphere.samples = int(read.integer("cache_samples"));
  cache_settings.metric =
      read.text("cache_metric") == "hessian" ? CacheMetric::hessian : CacheMetric::split_sphere;
  cache_settings.quality = read.number("cache_quality");
  cache_settings.gradients = read.boolean("cache_gradients");
  cache_settings.minimum_distance = read.boolean("minimum_distance");
  if (cache_settings.minimum_distance && !(cache && cache_settings.by_distance()))
    notes.emplace_back(
        "'minimum_distance' has no effect: it needs irradiance_cache = true and cache_metric = "
        "split_sphere");
  cache_settings.minimum_spacing = read.number("cache_minimum_spacing");
  cache_settings.maximum_spacing = read.number("cache_maximum_spacing");
  if (cache_settings.minimum_spacing > cache_settings.maximum_spacing)
    throw Error(ErrorKind::input,
                fmt::format("'cache_minimum_spacing' is {}, above 'cache_maximum_spacing', {}",
                            cache_settings.minimum_spacing, cache_settings.maximum_spacing),
                "give a least reach of at most the greatest one",
                arguments.place_of("cache_minimum_spacing"));
  const bool any_gather =
      components.has(Component::indirect) || components.has(Component::specular);
  volume_neighbors = int(read.integer("volume_neighbors"));
  const bool any_caustic = any_gather || components.has(Component::caustic);
  photon_file = arguments.text("photon_map");
  photon_file_place = arguments.place_of("photon_map");
  light_pass.traced = traced();
  light_pass.reradiate = read.boolean("reradiate");
  light_pass.aim = read_aim(read.text("aim"));
  light_pass.target_budget = int(read.integer("aim_targets"));
  light_pass.maximum_events = events_from(read.integer("max_light_level"));
  // A count of zero, to find or in total, switches that type of photon off, stored ones too.
  if (read.integer("global_photons") == 0) global.neighbors = 0;
  if (read.integer("caustic_photons") == 0) caustic.neighbors = 0;
  if (global.neighbors > 0 && any_gather)
    light_pass.global_photons = uint32_t(read.integer("global_photons"));
  if (caustic.neighbors > 0 && any_caustic)
    light_pass.caustic_photons = uint32_t(read.integer("caustic_photons"));
  if (volume_neighbors > 0 && (any_gather || components.has(Component::volume)))
    light_pass.volume_photons = uint32_t(read.integer("volume_photons"));
}

Lobes PhotonMapSettings::traced() const {
  return specular_sampling == SpecularSampling::importance ? Lobes::specular : Lobes::delta;
}

Lobes PhotonMapSettings::local() const {
  return Lobes(uint8_t(Lobes::all) & ~uint8_t(traced() | Lobes::delta));
}

float PhotonMapSettings::level_scale(int recursion) const {
  switch (level_of_detail) {
    case LevelOfDetail::none:
      return 1;
    case LevelOfDetail::linear:
      return std::max(0.05f, 1 - level_factor * float(recursion));
    case LevelOfDetail::exponential:
      return std::pow(level_factor, float(recursion));
  }
  return 1;
}

}  // namespace kaustik
