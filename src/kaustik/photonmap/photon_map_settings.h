#pragma once
#include "kaustik/base/to_integer.h"
#include "kaustik/irradiance/irradiance_cache.h"
#include "kaustik/photon/light_pass.h"
#include "kaustik/photon/shadow_pass.h"
#include "kaustik/transport/component.h"
#include "kaustik/transport/direct_light.h"

namespace kaustik {

/// What light the camera follows by tracing [thesis: specularSampling].
enum class SpecularSampling {
  none,       ///< nothing: specular light is left out
  perfect,    ///< mirrors and refraction only
  importance  ///< every specular lobe
};

/// How counts fall with the recursion level.
enum class LevelOfDetail { none, linear, exponential };

/// Where a surface stands on a path from the camera.
struct EyeLevel {
  int recursion = 0;  ///< events before it: what level of detail goes by
  int gathers = 0;    ///< gather rays among them
};

/// All parameters of the photon map integrator. Their defaults stand in photon_map_parameters().
struct PhotonMapSettings {
  ComponentSet components;
  LightPassSettings light_pass;
  std::string photon_file;  ///< stored maps to use instead of tracing; empty: none
  Place photon_file_place;
  EstimateSettings caustic, global;
  int volume_neighbors;
  float minimum_radiance;
  bool visibility;                      ///< what hides photons counts, and what covers disks
  float caustic_radius, global_radius;  ///< cap of pass 0, m; 0: from the photons

  LightChoice light_choice;
  int light_samples;
  uint32_t shadow_photons;  ///< rays to emit for them; 0: none
  ShadowSettings shadows;   ///< without the radius, which is each pass's own
  float shadow_radius;      ///< cap of pass 0, m; 0: from the photons
  int diffuse_samples;      ///< gather rays per camera sample where the cache does not serve
  int importance_photons;
  int gather_theta_cells, gather_phi_cells;
  bool importance_by_average;  ///< cells weighted by mean flux instead of summed flux
  float importance_floor;      ///< share of the samples that is spread evenly

  bool cache;
  CacheSettings cache_settings;

  SpecularSampling specular_sampling;
  int specular_samples;
  LevelOfDetail level_of_detail;
  float level_factor;
  int maximum_eye_level;
  bool gathers;  ///< diffuse indirect light, at what the camera sees
  bool count_specular_levels;
  uint32_t samples_per_pass;
  std::vector<std::string> notes;  ///< sentences about what is given without effect

  static const TypeInfo& info();
  explicit PhotonMapSettings(const Arguments& arguments);

  /// Lobes that are traced, and whose events are specular to light paths as well.
  Lobes traced() const;
  /// Lobes of `vertex` that photons light (all that are neither traced nor delta).
  Lobes local() const;
  /// Scale of counts at a recursion level (0: the camera's first surface).
  float level_scale(int recursion) const;
  /// A count at a recursion level, at least `least`.
  int count_at(int count, int recursion, int least = 1) const {
    return to_integer(float(count) * level_scale(recursion), least, 1 << 30);
  }
  /// How much larger an error of the irradiance cache is allowed at a recursion level.
  float cache_tolerance(int recursion) const { return 1 / level_scale(recursion); }
  /// Whether diffuse indirect light is estimated from the global map alone: at max_eye_level and
  /// beyond, but, where it is gathered at all, never at what the camera itself sees.
  bool approximates(const EyeLevel& level) const {
    return !gathers || (level.recursion > 0 && at_limit(level));
  }
  /// Whether specular light is followed from there.
  bool traces_specular(const EyeLevel& level) const {
    return specular_sampling != SpecularSampling::none &&
           !(count_specular_levels && at_limit(level));
  }

 private:
  bool at_limit(const EyeLevel& level) const {
    return (count_specular_levels ? level.recursion : level.gathers) >= maximum_eye_level;
  }
};

}  // namespace kaustik
