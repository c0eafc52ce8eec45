#include "kaustik/material/noise.h"

namespace kaustik {
namespace {

uint32_t cell_hash(int x, int y, int z, uint32_t seed) {
  uint32_t h = seed * 0x9e3779b9u + uint32_t(x) * 0x8da6b343u;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du + uint32_t(y) * 0xd8163841u;
  h = (h ^ (h >> 13)) * 0x297a2d39u + uint32_t(z) * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return h ^ (h >> 16);
}

/// One of the twelve directions to the middles of a cube's edges; all noise needs of them is that
/// they are even.
Vec3f edge_direction(uint32_t hash) {
  static constexpr float directions[16][3] = {{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0},
                                              {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
                                              {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1},
                                              {1, 1, 0}, {-1, 1, 0}, {0, -1, 1}, {0, -1, -1}};
  const float(&d)[3] = directions[hash >> 28];
  return {d[0], d[1], d[2]};
}

/// 6t⁵ − 15t⁴ + 10t³ and its derivative.
float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
float fade_slope(float t) { return 30 * t * t * (t * (t - 2) + 1); }

/// Far from the origin floats have lost the fraction anyway; this keeps cells in the range of int.
float in_range(float x) { return std::clamp(x, -1e9f, 1e9f); }

}  // namespace

NoiseValue gradient_noise(const Vec3f& p, uint32_t seed) {
  const Vec3f q(in_range(p.x), in_range(p.y), in_range(p.z));
  const Vec3f cell(std::floor(q.x), std::floor(q.y), std::floor(q.z)), f = q - cell;
  const float weight[3][2] = {
      {1 - fade(f.x), fade(f.x)}, {1 - fade(f.y), fade(f.y)}, {1 - fade(f.z), fade(f.z)}};
  const Vec3f slope(fade_slope(f.x), fade_slope(f.y), fade_slope(f.z));
  NoiseValue sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const Vec3f g =
        edge_direction(cell_hash(int(cell.x) + i, int(cell.y) + j, int(cell.z) + k, seed));
    const float v = dot(g, f - Vec3f(float(i), float(j), float(k)));
    const float wx = weight[0][i], wy = weight[1][j], wz = weight[2][k];
    sum.value += wx * wy * wz * v;
    sum.gradient += g * (wx * wy * wz) + Vec3f((i ? 1.0f : -1.0f) * slope.x * wy * wz,
                                               (j ? 1.0f : -1.0f) * slope.y * wx * wz,
                                               (k ? 1.0f : -1.0f) * slope.z * wx * wy) *
                                             v;
  }
  return sum;
}

NoiseValue FractalNoise::operator()(const Vec3f& p, float width) const {
  NoiseValue sum;
  float strength = 1, strengths = 0, frequency = 1;
  for (int i = 0; i < octaves; ++i, frequency *= 2, strength *= gain) {
    strengths += strength;
    const float visible = strength * noise_visibility(width * frequency);
    if (visible < 1e-4f) continue;
    // An offset of its own keeps the octaves' zeros, at the corners of their cells, apart.
    const Vec3f shifted = p * frequency + Vec3f(1.7f, 9.2f, 5.3f) * float(i);
    const NoiseValue octave = gradient_noise(shifted, seed + uint32_t(i)) * visible;
    sum.value += octave.value;
    sum.gradient += octave.gradient * frequency;
  }
  return sum * (1 / strengths);
}

float cell_random(int x, int y, int z, uint32_t seed) {
  return float(cell_hash(x, y, z, seed) >> 8) * 0x1p-24f;
}

}  // namespace kaustik
