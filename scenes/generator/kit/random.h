#pragma once
#include "kaustik/base/sampler.h"
#include "kit/mesh.h"

namespace kaustik::scenes {

/// A row of numbers that depends on its seed alone, on every machine.
class Random {
 public:
  explicit Random(uint64_t seed) : seed_(seed) {}
  double next() { return double(hash_mix(seed_, count_++) >> 11) * 0x1p-53; }  ///< in [0, 1)
  double between(double low, double high) { return low + (high - low) * next(); }
  /// In 0 … count - 1.
  size_t index(size_t count) { return size_t(next() * double(count)); }

 private:
  uint64_t seed_;
  uint64_t count_ = 0;
};

/// Smooth noise in [-1, 1] that varies over lengths of about 1 (values at the points of a grid,
/// interpolated with Perlin's quintic weights).
double noise(const Vec3d& p, uint64_t seed = 0);
/// Sum of `octaves` noises, each twice as fine and half as strong; in about [-1, 1].
double fractal_noise(const Vec3d& p, int octaves, uint64_t seed = 0);

}  // namespace kaustik::scenes
