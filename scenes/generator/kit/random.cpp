#include "kit/random.h"

namespace kaustik::scenes {
namespace {

double value_at(int64_t x, int64_t y, int64_t z, uint64_t seed) {
  const uint64_t h = hash_mix(hash_mix(hash_mix(seed, uint64_t(x)), uint64_t(y)), uint64_t(z));
  return double(h >> 11) * 0x1p-52 - 1;
}

double smooth_weight(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

double noise(const Vec3d& p, uint64_t seed) {
  const Vec3d low(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  const Vec3d t = p - low;
  const double w[3] = {smooth_weight(t.x), smooth_weight(t.y), smooth_weight(t.z)};
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int64_t at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = (corner >> axis) & 1;
      weight *= upper ? w[axis] : 1 - w[axis];
      at[axis] = int64_t(low[axis]) + upper;
    }
    sum += weight * value_at(at[0], at[1], at[2], seed);
  }
  return sum;
}

double fractal_noise(const Vec3d& p, int octaves, uint64_t seed) {
  double sum = 0, strength = 0.5, scale = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += strength * noise(p * scale, seed + uint64_t(i));
    strength *= 0.5;
    scale *= 2;
  }
  return sum;
}

}  // namespace kaustik::scenes
