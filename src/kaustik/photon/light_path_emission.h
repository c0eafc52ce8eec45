#pragma once
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/photon/emission.h"

namespace kaustik {

/// Density of an emitted ray in two factors.
struct EmissionDensity {
  /// Of the light's point, per area; of lights that are infinitely far away the direction, per
  /// solid angle; 1 for lights that are a single point or direction.
  float endpoint = 0;
  /// Of the rest, given that: the direction, per solid angle; of infinite lights the position, per
  /// area across the direction. The choice of the light is in it.
  float rest = 0;
};

/// A ray that a light path begins with.
struct LightPathStart {
  int light = -1;      ///< −1: nothing was emitted
  EmittedRay emitted;  ///< flux: over the density of all ways of emitting it together
  EmissionDensity density;
};

/// Emission of light paths that serve everything at once: first a light is chosen, then the light's
/// own distribution or, for a share of the rays, one that is aimed at specular objects; the density
/// is that of the mixture. Immutable.
class LightPathEmission {
 public:
  /// `scene` must outlive this.
  explicit LightPathEmission(const Scene& scene, Aim aim = default_aim);

  /// Three dimension pairs.
  LightPathStart sample(Sampler& sampler) const;
  /// Density with which sample() finds the ray: from `origin` on the light, or for infinite lights
  /// any point of its line.
  EmissionDensity pdf(int light, const SurfacePoint& origin, const Vec3f& direction) const;

 private:
  EmissionDensity density(int light, const SurfacePoint& origin, const Vec3f& direction) const;

  const Scene& scene_;
  EmissionSampler own_;
  std::vector<float> cumulative_;  ///< chances of the lights, summed up
  std::vector<float> chance_;
  EmissionSampler aimed_;
  float aimed_share_ = 0;
};

}  // namespace kaustik
