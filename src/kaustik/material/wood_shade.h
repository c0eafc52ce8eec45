#pragma once
#include "kaustik/material/noisy_ramp.h"

namespace kaustik {

/// 0 up to `from`, 1 beyond `to`, smooth between.
inline float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// How dark the wood of a trunk is: year rings about the x axis, fibres and pores along it.
///
/// What is seen over a footprint is a chain of means, each over what is finer than it tells: the
/// wood itself, that without its finest fibres, without pores, without fibres, the mean of all
/// wood. All of them have the same mean over the trunk, and so has what lies between two of them.
class WoodShade {
 public:
  WoodShade(float ring_width, float grain, uint32_t seed);

  /// 0 early wood, 1 late wood; `width` of the footprint. Both in m.
  float operator()(const Vec3f& p, float width) const;
  float mean() const { return mean_; }
  /// Within about ±1.
  float fibres(const Vec3f& p, float width) const;

 private:
  float rings(const Vec3f& p, float width) const;
  float pores(const Vec3f& p) const;
  Vec3f fibre_place(const Vec3f& p) const;

  float ring_, grain_;
  uint32_t seed_;
  FractalNoise fibres_;
  /// Means over the finest fibres, over pores and finer fibres, over all fibres and pores.
  NoisyRamp without_finest_, without_pores_, without_grain_;
  float mean_;
};

}  // namespace kaustik
