#include "kaustik/photonmap/photon_map_parameters.h"

#include "kaustik/photon/emission/emission.h"
#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {

const std::vector<PhotonMapParameter>& photon_map_parameters() {
  static const std::vector<PhotonMapParameter> table{
      {components_parameter()},
      {choice_parameter("preset", "default", {"default", "thesis"},
                        "Defaults of the parameters below: Kaustik's, or from Schregle's thesis "
                        "(1998, appendix A).")},
      {optional(
          file_parameter("photon_map",
                         "Photon maps of `kaustik photons`, used in every pass instead of new "
                         "ones. The reported error then covers only the noise of the view."))},
      {integer_parameter("caustic_neighbors", 60,
                         "Number of light paths whose nearest caustic photons an estimate uses "
                         "[numCaustic]; 0: no caustics.")
           .range(0, 100000),
       int64_t{0}},
      {integer_parameter(
           "caustic_photons", 250000,
           "Caustic photons emitted per pass, over all lights [totalCaustic]; 0: no caustics.")
           .range(0, 2000000000),
       int64_t{250000}},
      {choice_parameter("caustic_kernel", "cone", {"constant", "cone", "epanechnikov"},
                        "Weight of caustic photons by their distance."),
       std::string("cone")},
      {number_parameter("caustic_filter", 1,
                        "Constant k of the cone kernel [causticFilter]. 1 falls to zero at the "
                        "edge; larger values are flatter.")
           .range(1, 1e6),
       1.0},
      {integer_parameter("global_neighbors", 10,
                         "Number of light paths whose nearest global photons an estimate uses "
                         "[numGlobal]; 0: no diffuse indirect light.")
           .range(0, 100000),
       int64_t{50}},
      {integer_parameter("global_photons", 200000,
                         "Global photons emitted per pass, over all lights [totalGlobal]; 0: no "
                         "diffuse indirect light.")
           .range(0, 2000000000),
       int64_t{25000}},
      {choice_parameter("global_kernel", "constant", {"constant", "cone", "epanechnikov"},
                        "Weight of global photons by their distance.")},
      {integer_parameter(
           "volume_neighbors", 20,
           "The photon of this rank by distance sets the radius of a volume photon's disc in the "
           "first pass. Discs shrink in later passes. 0: no light from media.")
           .range(0, 100000)},
      {integer_parameter("volume_photons", 50000,
                         "Volume photons emitted per pass, over all lights. Each leaves one photon "
                         "on every segment of its path in a medium.")
           .range(0, 2000000000)},
      {integer_parameter("precompute_stride", 4,
                         "Number of global photons per place of precomputed irradiance, which "
                         "gather rays look up. 0: gather rays estimate it where they hit.")
           .range(0, 1000000),
       int64_t{0}},
      {boolean_parameter(
           "visibility", true,
           "Photons that something opaque hides do not count, so no light leaks through walls. "
           "Caustics also keep their brightness where a surface ends within a disk."),
       false},
      {number_parameter("minimum_radiance", 0,
                        "Smallest visible radiance [minRadiance]. It bounds the search for "
                        "photons; 0: no bound.")
           .range(0, 1e30)
           .in("W/(sr m²)"),
       0.004},
      {number_parameter(
           "caustic_radius", 0,
           "Largest search radius for caustic photons in the first pass. It shrinks in later "
           "passes, except with stored maps. 0: enough for three quarters of the photons.")
           .range(0, 1e30)
           .in("m")},
      {number_parameter("global_radius", 0,
                        "Largest search radius for global photons, like caustic_radius.")
           .range(0, 1e30)
           .in("m")},
      {boolean_parameter(
          "reradiate", false,
          "Caustic photons continue as global photons from where they land [reradiate].")},
      {aim_parameter()},
      {integer_parameter("aim_targets", default_target_budget,
                         "Number of boxes into which specular objects are divided for aiming "
                         "[distribQuality]. Only projection_map uses more than 128.")
           .range(1, 4096),
       int64_t{32}},
      {integer_parameter("max_light_level", -1,
                         "Longest light path in scattering events [-l]; -1: no limit.")
           .range(-1, 1 << 20)},
      {integer_parameter("max_eye_level", 1,
                         "Number of levels that gather diffuse indirect light [-e]. Deeper levels "
                         "estimate it from the global map; the surfaces in view never do.")
           .range(0, 64)},
      {boolean_parameter("gather", true,
                         "Gathers diffuse indirect light at the surfaces in view. If false, the "
                         "global map gives it there, too: fast, but blotchy.")},
      {boolean_parameter("count_specular_levels", false,
                         "Counts mirrors and refractions as levels, too, and drops specular light "
                         "at max_eye_level. As in the thesis, light is lost."),
       true},
      {choice_parameter("light_sampling", "one", {"one", "all"},
                        "Lights that a surface samples: one for each shadow ray, chosen by its "
                        "possible contribution, or all, as in the thesis."),
       std::string("all")},
      {integer_parameter("light_samples", 1,
                         "Shadow rays per camera sample. If all lights are sampled, the rays are "
                         "divided by incident flux, at least one each.")
           .range(1, 4096)},
      {integer_parameter("shadow_photons", 0,
                         "Rays emitted per pass for shadow photons, over all lights. Where all "
                         "nearby photons of a light agree, no shadow ray is traced. Biased: shadow "
                         "edges are coarse, less so in later passes. 0: only shadow rays.")
           .range(0, 2000000000)},
      {integer_parameter("shadow_neighbors", 50,
                         "Number of shadow photons that an estimate uses, of all lights together.")
           .range(1, 100000)},
      {number_parameter("shadow_radius", 0,
                        "Largest search radius for shadow photons in the first pass. It shrinks in "
                        "later passes. 0: enough for three quarters of the photons.")
           .range(0, 1e30)
           .in("m")},
      {integer_parameter("shadow_accurate_levels", 1,
                         "Recursion levels that trace shadow rays in penumbrae. Deeper levels, "
                         "such as gather rays, use the fraction of lit photons.")
           .range(0, 1 << 20)},
      {integer_parameter("diffuse_samples", 4,
                         "Gather rays per camera sample where the irradiance cache is not used "
                         "[numDiffuse]. Deeper levels gather with one ray each.")
           .range(1, 1000000),
       int64_t{50}},
      {integer_parameter("importance_photons", 50,
                         "Global photons whose directions guide the gather rays. The grid has no "
                         "more cells than this.")
           .range(1, 100000)},
      {integer_parameter("importance_theta_cells", 3,
                         "Rings of the grid that guides gather rays [impThetaIntervals].")
           .range(1, 1000),
       int64_t{3}},
      {integer_parameter("importance_phi_cells", 14,
                         "Sectors of the grid that guides gather rays [impPhiIntervals].")
           .range(1, 1000),
       int64_t{14}},
      {choice_parameter("importance_weight", "sum", {"sum", "average"},
                        "Weight of a grid cell: the sum of its photons' flux, or its average, as "
                        "in the thesis."),
       std::string("average")},
      {number_parameter("importance_floor", 0.25,
                        "Fraction of gather rays that go to all cells equally. 0 leaves out cells "
                        "without photons (biased, as in the thesis).")
           .range(0, 1),
       0.0},
      {choice_parameter("specular_sampling", "importance", {"none", "perfect", "importance"},
                        "Specular light: none, only mirrors and refraction, or all specular lobes "
                        "by importance sampling [specularSampling]."),
       std::string("none")},
      {integer_parameter("specular_samples", 1,
                         "Specular rays at the first surface of a camera sample [numSpecular].")
           .range(1, 100000),
       int64_t{25}},
      {choice_parameter("level_of_detail", "none", {"none", "linear", "exponential"},
                        "How sample counts fall with the recursion level.")},
      {number_parameter("level_factor", 0.5,
                        "Fraction of samples at a level: 1 − factor × level (linear), or factor to "
                        "the power of the level (exponential).")
           .range(0, 1)},
      {boolean_parameter("irradiance_cache", true,
                         "Interpolates diffuse indirect light between points where it was "
                         "gathered. Every point gathers as at recursion level 0."),
       false},
      {integer_parameter("cache_samples", 128, "Gather rays per cache record.").range(4, 1000000)},
      {choice_parameter(
           "cache_metric", "hessian", {"split_sphere", "hessian"},
           "Measure for the radius of a cache record: the distance of the surfaces that it sees "
           "(as in the thesis), or the second derivative of the irradiance."),
       std::string("split_sphere")},
      {number_parameter("cache_quality", 0.25,
                        "Allowed error of the cache in the first pass; lower is denser. It shrinks "
                        "in later passes like the search radii, and so do the spacings.")
           .range(1e-3, 10)},
      {boolean_parameter("cache_gradients", true,
                         "Interpolates with gradients. Without them the metric is split_sphere, "
                         "because hessian measures only the error that gradients leave.")},
      {boolean_parameter(
          "minimum_distance", false,
          "Uses the minimum distance of the surfaces that a record sees, instead of the harmonic "
          "mean [minDist]. Needs the cache with cache_metric = split_sphere.")},
      {number_parameter("cache_minimum_spacing", 3,
                        "Smallest radius of a cache record in the first pass.")
           .range(0, 1e6)
           .in("pixels")},
      {number_parameter("cache_maximum_spacing", 40,
                        "Largest radius of a cache record in the first pass.")
           .range(1, 1e6)
           .in("pixels")},
      {integer_parameter("samples_per_pass", 16, "Camera samples per pixel and pass.")
           .range(1, 65536)},
  };
  return table;
}

}  // namespace kaustik
