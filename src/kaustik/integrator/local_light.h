#pragma once
// What the classical illumination models know of the light at a surface: what comes straight from
// the lamps, and a constant for all the rest.
#include "kaustik/base/spectral_value.h"
#include "kaustik/transport/illumination_model.h"

namespace kaustik {

/// Light at a vertex without regard to other surfaces, but for their shadows.
class LocalLight {
 public:
  /// The rows that its constructor reads.
  static std::vector<Parameter> parameters();
  explicit LocalLight(const Arguments& arguments);

  /// Adds what `lobes` of the walk's vertex reflect of direct and of ambient light.
  void add_to(CameraWalk& walk, Lobes lobes) const;

 private:
  LightSampling sampling_;
  LightRules rules_;
  SpectralValue ambient_;  ///< radiance that comes from everywhere, W/(sr·m²)
};

}  // namespace kaustik
