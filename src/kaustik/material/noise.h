#pragma once
#include <array>
#include <cstdint>

#include "kaustik/base/vec.h"

namespace kaustik {

/// A value with its gradient by the position.
struct NoiseValue {
  float value = 0;
  Vec3f gradient{0, 0, 0};

  friend NoiseValue operator+(NoiseValue a, const NoiseValue& b) {
    return {a.value + b.value, a.gradient + b.gradient};
  }
  friend NoiseValue operator*(NoiseValue a, float s) { return {a.value * s, a.gradient * s}; }
};

/// Gradient noise: mean 0, within about ±1, features of size 1, twice differentiable (Perlin,
/// "Improving Noise", SIGGRAPH 2002; gradients by a hash, without period).
NoiseValue gradient_noise(const Vec3f& p, uint32_t seed);
/// Its value alone, faster.
float gradient_noise_value(const Vec3f& p, uint32_t seed);
/// Three such values that have nothing to do with each other, x being gradient_noise's, faster than
/// one by one.
Vec3f noise_vector(const Vec3f& p, uint32_t seed);

/// What such values are like over space: their means within classes that are equally frequent, from
/// the lowest to the highest. Symmetrical about 0.
using NoiseClasses = std::array<float, 256>;
const NoiseClasses& noise_classes();

/// How much is left of noise with features of size 1 in a mean over a footprint: near to 1 for
/// widths below a half, to 0 for widths over 2.
inline float noise_visibility(float width) { return std::exp(-0.8f * width * width); }

/// Sum of octaves of noise, each twice as fine as the one before and `gain` times as strong, over
/// the sum of their strengths. Octaves finer than the footprint fade out.
struct FractalNoise {
  int octaves = 6;
  float gain = 0.5f;
  uint32_t seed = 0;

  NoiseValue operator()(const Vec3f& p, float width) const;
  /// Without the gradient, faster.
  float value(const Vec3f& p, float width) const;
  /// Of three noises, each on its own.
  Vec3f vector(const Vec3f& p, float width) const;
  /// What one octave adds to value() at width 0.
  float octave(int i, const Vec3f& p) const;
  /// Its share of the octaves' strengths.
  float share(int i) const;

 private:
  template <class Value, class Noise>
  Value octave_sum(Value sum, const Vec3f& p, float width, const Noise& noise) const;
};

/// A uniform number in [0, 1) for a cell of a grid.
float cell_random(int x, int y, int z, uint32_t seed);

}  // namespace kaustik
