#include "kaustik/photonmap/photon_map_parameters.h"

#include "kaustik/photon/emission/emission.h"
#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {

const std::vector<PhotonMapParameter>& photon_map_parameters() {
  static const std::vector<PhotonMapParameter> table{
      {components_parameter()},
      {choice_parameter(
          "preset", "default", {"default", "thesis"},
          "Defaults of the parameters below: Kaustik's, or those of Schregle's thesis "
          "(1998, appendix A).")},
      {optional(file_parameter(
          "photon_map",
          "Maps made by `kaustik photons` to use in every pass instead of tracing new ones; "
          "the error that is told is then the noise of the view alone."))},
      {integer_parameter("caustic_neighbors", 60,
                         "Caustic photons to find [numCaustic]; 0: no caustics.")
           .range(0, 100000),
       int64_t{0}},
      {integer_parameter("caustic_photons", 250000,
                         "Caustic photons to emit in a pass, over all lights [totalCaustic]; 0: no "
                         "caustics.")
           .range(0, 2000000000),
       int64_t{250000}},
      {choice_parameter("caustic_kernel", "cone", {"constant", "cone", "epanechnikov"},
                        "How caustic photons are weighted by their distance."),
       std::string("cone")},
      {number_parameter("caustic_filter", 1,
                        "Constant k of the cone kernel: 1 falls to zero at the edge, larger is "
                        "flatter [causticFilter].")
           .range(1, 1e6),
       1.0},
      {integer_parameter("global_neighbors", 10,
                         "Global photons to find [numGlobal]; 0: no diffuse indirect light.")
           .range(0, 100000),
       int64_t{50}},
      {integer_parameter("global_photons", 200000,
                         "Global photons to emit in a pass, over all lights [totalGlobal]; 0: no "
                         "diffuse indirect light.")
           .range(0, 2000000000),
       int64_t{25000}},
      {choice_parameter("global_kernel", "constant", {"constant", "cone", "epanechnikov"},
                        "How global photons are weighted by their distance.")},
      {integer_parameter("volume_neighbors", 20,
                         "Photon whose distance is the radius of a volume photon's disc in the "
                         "first pass; it shrinks in later ones; 0: no light from media.")
           .range(0, 100000)},
      {integer_parameter("volume_photons", 50000,
                         "Photons to emit in a pass, over all lights, for the light that media "
                         "scatter; each leaves one on every segment of its path through a medium.")
           .range(0, 2000000000)},
      {integer_parameter(
           "precompute_stride", 4,
           "Gather rays look up irradiance that is computed beforehand at one place for "
           "so many global photons; 0: they estimate it where they hit.")
           .range(0, 1000000),
       int64_t{0}},
      {boolean_parameter("visibility", true,
                         "Photons do not count where something opaque hides them, so that no light "
                         "leaks through walls, and where a surface ends within a disk of caustic "
                         "photons the camera sees no less light."),
       false},
      {number_parameter(
           "minimum_radiance", 0,
           "Least visible radiance: bounds the search for photons [minRadiance]; 0: no "
           "bound.")
           .range(0, 1e30)
           .in("W/(sr m²)"),
       0.004},
      {number_parameter(
           "caustic_radius", 0,
           "Largest search radius for caustic photons in the first pass, it shrinks in "
           "later ones (not of stored maps); 0: what is enough for three quarters of "
           "the photons.")
           .range(0, 1e30)
           .in("m")},
      {number_parameter("global_radius", 0, "The same for global photons.").range(0, 1e30).in("m")},
      {boolean_parameter("reradiate", false,
                         "Caustic photons go on as global ones from where they land [reradiate].")},
      {aim_parameter()},
      {integer_parameter("aim_targets", default_target_budget,
                         "Boxes that specular objects are divided into for that [distribQuality]; "
                         "above 128 only projection_map uses more.")
           .range(1, 4096),
       int64_t{32}},
      {integer_parameter("max_light_level", -1,
                         "Longest light path in scattering events [-l]; -1: any.")
           .range(-1, 1 << 20)},
      {integer_parameter("max_eye_level", 1,
                         "Levels at which diffuse indirect light is gathered; from there on it is "
                         "estimated from the global map, but never at what the camera itself sees "
                         "[-e].")
           .range(0, 64)},
      {boolean_parameter("gather", true,
                         "Diffuse indirect light is gathered at what the camera sees; if false, it "
                         "is estimated from the global map there, too: blotchy, but soon there.")},
      {boolean_parameter("count_specular_levels", false,
                         "Mirrors and refractions count as levels too, and at max_eye_level "
                         "specular light is left out, as in the thesis: light is lost."),
       true},
      {choice_parameter("light_sampling", "one", {"one", "all"},
                        "Lights that a surface samples: one for each shadow ray, chosen by what it "
                        "may send, or every one, as in the thesis."),
       std::string("all")},
      {integer_parameter("light_samples", 1,
                         "Shadow rays per camera sample; where every light is sampled, they are "
                         "shared among the lights by incident flux, and each has one at least.")
           .range(1, 4096)},
      {integer_parameter("shadow_photons", 0,
                         "Rays to emit in a pass for shadow photons, over all lights: where all of "
                         "a light's photons nearby are lit, or all are in shadow, no shadow ray is "
                         "traced (biased: shadows get coarse edges, less so in later passes); 0: "
                         "shadow rays alone.")
           .range(0, 2000000000)},
      {integer_parameter("shadow_neighbors", 50, "Shadow photons to find, of all lights together.")
           .range(1, 100000)},
      {number_parameter("shadow_radius", 0,
                        "Largest search radius for shadow photons in the first pass, it shrinks in "
                        "later ones; 0: what is enough for three quarters of the photons.")
           .range(0, 1e30)
           .in("m")},
      {integer_parameter(
           "shadow_accurate_levels", 1,
           "Recursion levels that trace shadow rays in penumbrae; deeper ones, gather "
           "rays among them, take the share of the lit photons.")
           .range(0, 1 << 20)},
      {integer_parameter("diffuse_samples", 4,
                         "Gather rays per camera sample where the irradiance cache does not serve "
                         "[numDiffuse]; those that gather again send one each.")
           .range(1, 1000000),
       int64_t{50}},
      {integer_parameter(
           "importance_photons", 50,
           "Global photons whose directions direct the gather rays; the grid has no more "
           "cells than that.")
           .range(1, 100000)},
      {integer_parameter("importance_theta_cells", 3,
                         "Rings of the grid that directs gather rays [impThetaIntervals].")
           .range(1, 1000),
       int64_t{3}},
      {integer_parameter("importance_phi_cells", 14, "Sectors of that grid [impPhiIntervals].")
           .range(1, 1000),
       int64_t{14}},
      {choice_parameter(
           "importance_weight", "sum", {"sum", "average"},
           "Cells of the grid count by the sum of their photons' flux, or by its average "
           "as in the thesis."),
       std::string("average")},
      {number_parameter("importance_floor", 0.25,
                        "Share of the gather rays that goes to all cells alike; 0 leaves out cells "
                        "without photons (biased, as in the thesis).")
           .range(0, 1),
       0.0},
      {choice_parameter(
           "specular_sampling", "importance", {"none", "perfect", "importance"},
           "Specular light: none, mirrors and refraction only, or all specular lobes by "
           "importance sampling [specularSampling]."),
       std::string("none")},
      {integer_parameter("specular_samples", 1,
                         "Specular rays at the first surface of a camera sample [numSpecular].")
           .range(1, 100000),
       int64_t{25}},
      {choice_parameter("level_of_detail", "none", {"none", "linear", "exponential"},
                        "How the counts fall with the recursion level.")},
      {number_parameter("level_factor", 0.5,
                        "By how much: 1 − factor × level, or factor to the power of the level.")
           .range(0, 1)},
      {boolean_parameter("irradiance_cache", true,
                         "Interpolate diffuse indirect light between points where it was gathered, "
                         "as at recursion level 0 whatever level they are seen at."),
       false},
      {integer_parameter("cache_samples", 128, "Gather rays per cache record.").range(4, 1000000)},
      {choice_parameter("cache_metric", "hessian", {"split_sphere", "hessian"},
                        "What tells how far a record of the cache serves: the distance of what it "
                        "sees [the thesis's], or the second derivative of the irradiance."),
       std::string("split_sphere")},
      {number_parameter("cache_quality", 0.25,
                        "Allowed error of the cache in the first pass: lower is denser. It shrinks "
                        "in later ones as the search radii do, and so do the spacings.")
           .range(1e-3, 10)},
      {boolean_parameter("cache_gradients", true,
                         "Interpolate with gradients; without them the metric is split_sphere, for "
                         "the other one tells only what gradients leave out.")},
      {boolean_parameter(
          "minimum_distance", false,
          "Records reach by the minimum instead of the harmonic mean distance of what "
          "they see [minDist]; needs the cache, with cache_metric = split_sphere.")},
      {number_parameter("cache_minimum_spacing", 3, "Least reach of a record in the first pass.")
           .range(0, 1e6)
           .in("pixels")},
      {number_parameter("cache_maximum_spacing", 40,
                        "Greatest reach of a record in the first pass.")
           .range(1, 1e6)
           .in("pixels")},
      {integer_parameter("samples_per_pass", 16, "Camera samples per pixel and pass.")
           .range(1, 65536)},
  };
  return table;
}

}  // namespace kaustik
