#include "kaustik/photonmap/photon_map_settings.h"

#include <fmt/format.h>

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
  /// The defaults of Schregle 1998, appendix A.
  const Value* preset(const char* name) const {
    static const std::vector<std::pair<std::string, Value>> table{
        {"caustic_neighbors", int64_t{0}},
        {"caustic_photons", int64_t{250000}},
        {"caustic_kernel", std::string("cone")},
        {"caustic_filter", 1.0},
        {"global_neighbors", int64_t{50}},
        {"global_photons", int64_t{25000}},
        {"diffuse_samples", int64_t{50}},
        {"importance_theta_cells", int64_t{3}},
        {"importance_phi_cells", int64_t{14}},
        {"importance_weight", std::string("average")},
        {"importance_floor", 0.0},
        {"specular_sampling", std::string("none")},
        {"specular_samples", int64_t{25}},
        {"minimum_radiance", 0.004},
        {"count_specular_levels", true},
        {"aim_targets", int64_t{32}},
        {"precompute_stride", int64_t{0}},
        {"visibility", false},
        {"irradiance_cache", false},
        {"light_sampling", std::string("all")},
        {"cache_metric", std::string("split_sphere")},
    };
    if (!thesis_ || arguments_.given(name)) return nullptr;
    for (const auto& [key, value] : table)
      if (key == name) return &value;
    return nullptr;
  }

  const Arguments& arguments_;
  bool thesis_;
};

std::vector<Parameter> parameters() {
  return {
      components_parameter(),
      choice_parameter("preset", "default", {"default", "thesis"},
                       "Defaults of the parameters below: Kaustik's, or those of Schregle's thesis "
                       "(1998, appendix A)."),
      optional(file_parameter(
          "photon_map",
          "Maps made by `kaustik photons` to use in every pass instead of tracing new ones; "
          "the error that is told is then the noise of the view alone.")),
      integer_parameter("caustic_neighbors", 60,
                        "Caustic photons to find [numCaustic]; 0: no caustics.")
          .range(0, 100000),
      integer_parameter("caustic_photons", 250000,
                        "Caustic photons to emit in a pass, over all lights [totalCaustic]; 0: no "
                        "caustics.")
          .range(0, 2000000000),
      choice_parameter("caustic_kernel", "cone", {"constant", "cone", "epanechnikov"},
                       "How caustic photons are weighted by their distance."),
      number_parameter("caustic_filter", 1,
                       "Constant k of the cone kernel: 1 falls to zero at the edge, larger is "
                       "flatter [causticFilter].")
          .range(1, 1e6),
      integer_parameter("global_neighbors", 10,
                        "Global photons to find [numGlobal]; 0: no diffuse indirect light.")
          .range(0, 100000),
      integer_parameter("global_photons", 200000,
                        "Global photons to emit in a pass, over all lights [totalGlobal]; 0: no "
                        "diffuse indirect light.")
          .range(0, 2000000000),
      choice_parameter("global_kernel", "constant", {"constant", "cone", "epanechnikov"},
                       "How global photons are weighted by their distance."),
      integer_parameter("volume_neighbors", 20,
                        "Photon whose distance is the radius of a volume photon's disc in the "
                        "first pass; it shrinks in later ones; 0: no light from media.")
          .range(0, 100000),
      integer_parameter("volume_photons", 50000,
                        "Photons to emit in a pass, over all lights, for the light that media "
                        "scatter; each leaves one on every segment of its path through a medium.")
          .range(0, 2000000000),
      integer_parameter(
          "precompute_stride", 4,
          "Gather rays look up irradiance that is computed beforehand at one place for "
          "so many global photons; 0: they estimate it where they hit.")
          .range(0, 1000000),
      boolean_parameter("visibility", true,
                        "Photons do not count where something opaque hides them, so that no light "
                        "leaks through walls, and where a surface ends within a disk of caustic "
                        "photons the camera sees no less light."),
      number_parameter("minimum_radiance", 0,
                       "Least visible radiance: bounds the search for photons [minRadiance]; 0: no "
                       "bound.")
          .range(0, 1e30)
          .in("W/(sr m²)"),
      number_parameter("caustic_radius", 0,
                       "Largest search radius for caustic photons in the first pass, it shrinks in "
                       "later ones (not of stored maps); 0: what is enough for three quarters of "
                       "the photons.")
          .range(0, 1e30)
          .in("m"),
      number_parameter("global_radius", 0, "The same for global photons.").range(0, 1e30).in("m"),
      boolean_parameter("reradiate", false,
                        "Caustic photons go on as global ones from where they land [reradiate]."),
      aim_parameter(),
      integer_parameter("aim_targets", default_target_budget,
                        "Boxes that specular objects are divided into for that [distribQuality]; "
                        "above 128 only projection_map uses more.")
          .range(1, 4096),
      integer_parameter("max_light_level", -1,
                        "Longest light path in scattering events [-l]; -1: any.")
          .range(-1, 1 << 20),
      integer_parameter("max_eye_level", 1,
                        "Levels at which diffuse indirect light is gathered; from there on it is "
                        "estimated from the global map, but never at what the camera itself sees "
                        "[-e].")
          .range(0, 64),
      boolean_parameter("count_specular_levels", false,
                        "Mirrors and refractions count as levels too, and at max_eye_level "
                        "specular light is left out, as in the thesis: light is lost."),
      choice_parameter("light_sampling", "one", {"one", "all"},
                       "Lights that a surface samples: one for each shadow ray, chosen by what it "
                       "may send, or every one, as in the thesis."),
      integer_parameter("light_samples", 1,
                        "Shadow rays per camera sample; where every light is sampled, they are "
                        "shared among the lights by incident flux, and each has one at least.")
          .range(1, 4096),
      integer_parameter("shadow_photons", 0,
                        "Rays to emit in a pass for shadow photons, over all lights: where all of "
                        "a light's photons nearby are lit, or all are in shadow, no shadow ray is "
                        "traced (biased: shadows get coarse edges, less so in later passes); 0: "
                        "shadow rays alone.")
          .range(0, 2000000000),
      integer_parameter("shadow_neighbors", 50, "Shadow photons to find, of all lights together.")
          .range(1, 100000),
      number_parameter("shadow_radius", 0,
                       "Largest search radius for shadow photons in the first pass, it shrinks in "
                       "later ones; 0: what is enough for three quarters of the photons.")
          .range(0, 1e30)
          .in("m"),
      integer_parameter("shadow_accurate_levels", 1,
                        "Recursion levels that trace shadow rays in penumbrae; deeper ones, gather "
                        "rays among them, take the share of the lit photons.")
          .range(0, 1 << 20),
      integer_parameter("diffuse_samples", 4,
                        "Gather rays per camera sample where the irradiance cache does not serve "
                        "[numDiffuse]; those that gather again send one each.")
          .range(1, 1000000),
      integer_parameter(
          "importance_photons", 50,
          "Global photons whose directions direct the gather rays; the grid has no more "
          "cells than that.")
          .range(1, 100000),
      integer_parameter("importance_theta_cells", 3,
                        "Rings of the grid that directs gather rays [impThetaIntervals].")
          .range(1, 1000),
      integer_parameter("importance_phi_cells", 14, "Sectors of that grid [impPhiIntervals].")
          .range(1, 1000),
      choice_parameter(
          "importance_weight", "sum", {"sum", "average"},
          "Cells of the grid count by the sum of their photons' flux, or by its average "
          "as in the thesis."),
      number_parameter("importance_floor", 0.25,
                       "Share of the gather rays that goes to all cells alike; 0 leaves out cells "
                       "without photons (biased, as in the thesis).")
          .range(0, 1),
      choice_parameter(
          "specular_sampling", "importance", {"none", "perfect", "importance"},
          "Specular light: none, mirrors and refraction only, or all specular lobes by "
          "importance sampling [specularSampling]."),
      integer_parameter("specular_samples", 1,
                        "Specular rays at the first surface of a camera sample [numSpecular].")
          .range(1, 100000),
      choice_parameter("level_of_detail", "none", {"none", "linear", "exponential"},
                       "How the counts fall with the recursion level."),
      number_parameter("level_factor", 0.5,
                       "By how much: 1 − factor × level, or factor to the power of the level.")
          .range(0, 1),
      boolean_parameter("irradiance_cache", true,
                        "Interpolate diffuse indirect light between points where it was gathered, "
                        "as at recursion level 0 whatever level they are seen at."),
      integer_parameter("cache_samples", 128, "Gather rays per cache record.").range(4, 1000000),
      choice_parameter("cache_metric", "hessian", {"split_sphere", "hessian"},
                       "What tells how far a record of the cache serves: the distance of what it "
                       "sees [the thesis's], or the second derivative of the irradiance."),
      number_parameter("cache_quality", 0.25,
                       "Allowed error of the cache in the first pass: lower is denser. It shrinks "
                       "in later ones as the search radii do, and so do the spacings.")
          .range(1e-3, 10),
      boolean_parameter("cache_gradients", true,
                        "Interpolate with gradients; without them the metric is split_sphere, for "
                        "the other one tells only what gradients leave out."),
      boolean_parameter(
          "minimum_distance", false,
          "Records reach by the minimum instead of the harmonic mean distance of what "
          "they see [minDist]; needs the cache, with cache_metric = split_sphere."),
      number_parameter("cache_minimum_spacing", 3, "Least reach of a record in the first pass.")
          .range(0, 1e6)
          .in("pixels"),
      number_parameter("cache_maximum_spacing", 40, "Greatest reach of a record in the first pass.")
          .range(1, 1e6)
          .in("pixels"),
      integer_parameter("samples_per_pass", 16, "Camera samples per pixel and pass.")
          .range(1, 65536),
  };
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
      "global photon map with an irradiance cache, specular light by tracing. Names in [] are "
      "those "
      "of Schregle's thesis.",
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
