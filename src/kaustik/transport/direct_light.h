#pragma once
#include "kaustik/base/sampler.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// Light that arrives at a vertex straight from a light, found by sampling one light.
struct DirectLight {
  Vec3f wi;           ///< unit, toward the light
  Spectrum radiance;  ///< arriving radiance over its density, W/m² per projected sr: multiply
                      ///< by f·cosine; without visibility
  float pdf_solid_angle = 0;  ///< choice of the light included; 0 for delta lights (no MIS)
  Ray shadow_ray;             ///< occluded: no light
};

/// Samples one light; false if nothing can arrive. Two dimension pairs of `sampler`.
bool sample_direct_light(const Scene& scene, const SurfaceVertex& vertex, Sampler& sampler,
                         DirectLight& result);

/// Density per solid angle with which sample_direct_light at `vertex` finds the point `on_light` of
/// an area light …
float direct_light_pdf(const Scene& scene, const SurfaceVertex& vertex, int light,
                       const SurfacePoint& on_light);
/// … or an environment light in `direction`.
float direct_light_pdf(const Scene& scene, const SurfaceVertex& vertex, int light,
                       const Vec3f& direction);

/// Power heuristic with exponent 2 for one sample each (Veach 1997).
inline float mis_weight(float pdf, float other_pdf) {
  if (!(pdf > 0)) return 0;
  const float ratio = other_pdf / pdf;  // squares of densities may overflow, those of ratios vanish
  return 1 / (1 + ratio * ratio);
}

/// One of the two classes of lobes (diffuse, specular) of a vertex, chosen by their albedos, so
/// that every path knows the class of each of its events. `u` becomes a fresh uniform number.
struct LobeChoice {
  Lobes lobes = Lobes::none;
  float probability = 1;
};
LobeChoice choose_lobes(const SurfaceVertex& vertex, float& u);
/// The probability with which choose_lobes picks the diffuse class.
float diffuse_probability(const SurfaceVertex& vertex);

}  // namespace kaustik
