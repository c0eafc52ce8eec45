#pragma once
#include <utility>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// Where light arrives: on a surface or in a medium.
struct Receiver {
  Receiver() = default;
  /// On a surface only light on the viewer's side counts, unless it transmits.
  Receiver(const SurfaceVertex& vertex, int recursion_level = 0);  // NOLINT: a vertex is one
  /// In a medium.
  explicit Receiver(const Vec3f& position, int recursion_level = 0) : level(recursion_level) {
    point.position = position;
  }

  /// What lights are asked with, by sampling and by densities alike.
  LightQuery query() const { return {point.position, normal, level}; }

  SurfacePoint point;     ///< without a normal in a medium
  Vec3f normal{0, 0, 0};  ///< light arrives from its half space; zero: from anywhere
  int level = 0;          ///< see LightQuery::level; 0: what the camera itself sees
};

/// Light that arrives at a vertex straight from a light, found by sampling one light.
struct DirectLight {
  int light = -1;     ///< index in the scene
  Vec3f wi;           ///< unit, toward the light
  Spectrum radiance;  ///< arriving radiance over its density, W/m² per projected sr: multiply
                      ///< by f·cosine (in a medium: by the phase function); without visibility
  float pdf_solid_angle =
      0;           ///< choice of the light included; 0 where no ray meets the light (no MIS)
  Ray shadow_ray;  ///< occluded: no light
};

/// Which lights a vertex samples.
enum class LightChoice {
  one,  ///< one for each sample, chosen in proportion to what it may send there
  all   ///< every one that may reach the vertex
};

/// How many samples of direct light a vertex takes.
struct LightSampling {
  LightChoice choice = LightChoice::one;
  /// With LightChoice::all shared among the lights, see share_light_samples. At least 1.
  int samples = 1;
};

/// Samples one light; false if nothing can arrive. Two dimension pairs of `sampler`.
bool sample_direct_light(const Scene& scene, const Receiver& receiver, Sampler& sampler,
                         DirectLight& result);
/// Samples light `light`; false if nothing can arrive.
bool sample_direct_light_of(const Scene& scene, const Receiver& receiver, int light, const Vec2f& u,
                            DirectLight& result);
/// How many of `samples` each light gets with LightChoice::all: in proportion to the irradiance
/// that it may bring, at least one, and none where no light can arrive.
void share_light_samples(const Scene& scene, const Receiver& receiver, int samples,
                         std::vector<int>& counts);

/// Calls `take(const DirectLight&)` for every sample that may bring light. Their radiances are
/// already divided by the numbers of samples: what they reflect, summed, is the estimate. At most
/// two dimension pairs of `sampler`.
template <typename Take>
void sample_direct_lights(const Scene& scene, const Receiver& receiver,
                          const LightSampling& sampling, Sampler& sampler, const Take& take);

/// Density per solid angle with which a sample at `receiver` finds the point `on_light` of an area
/// light …
float direct_light_pdf(const Scene& scene, const Receiver& receiver, LightChoice choice, int light,
                       const SurfacePoint& on_light);
/// … or an environment light in `direction`.
float direct_light_pdf(const Scene& scene, const Receiver& receiver, LightChoice choice, int light,
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

template <typename Take>
void sample_direct_lights(const Scene& scene, const Receiver& receiver,
                          const LightSampling& sampling, Sampler& sampler, const Take& take) {
  DirectLight light;
  const auto take_share = [&](int count) {
    light.radiance *= 1.0f / float(count);
    take(std::as_const(light));
  };
  if (sampling.choice == LightChoice::one) {
    if (sampling.samples == 1) {
      if (sample_direct_light(scene, receiver, sampler, light)) take_share(1);
      return;
    }
    for (int i = 0; i < sampling.samples; ++i) {
      Sampler branch = sampler.split(0, uint32_t(i));
      if (sample_direct_light(scene, receiver, branch, light)) take_share(sampling.samples);
    }
    return;
  }
  static thread_local std::vector<int> counts;
  share_light_samples(scene, receiver, sampling.samples, counts);
  for (size_t i = 0; i < counts.size(); ++i) {
    const int count = counts[i];
    const Sampler of_light = sampler.fork(uint32_t(i));
    for (int k = 0; k < count; ++k) {
      Sampler branch = count == 1 ? of_light : of_light.split(0, uint32_t(k));
      if (sample_direct_light_of(scene, receiver, int(i), branch.next_2d(), light))
        take_share(count);
    }
  }
}

}  // namespace kaustik
