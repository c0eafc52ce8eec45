#include "kaustik/loader/pbrt/cloud_density.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kaustik/base/parallel.h"

namespace kaustik::pbrt {
namespace {

constexpr size_t period = 256;
/// Perlin's own order of the numbers below 256.
constexpr uint8_t shuffled[period] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

uint8_t shuffled_at(size_t i) { return shuffled[i % period]; }

/// The product of a cell's gradient with a vector from it.
double along_gradient(const std::array<size_t, 3>& cell, const Vec3d& from) {
  const unsigned hash = shuffled_at(shuffled_at(shuffled_at(cell[0]) + cell[1]) + cell[2]) & 15u;
  const bool is_xy = hash < 4 || hash == 12 || hash == 13;
  const double first = hash < 8 || is_xy ? from.x : from.y;
  const double second = is_xy ? from.y : from.z;
  return (hash & 1 ? -first : first) + (hash & 2 ? -second : second);
}

/// From 0 to 1, with first and second derivatives of 0 at both.
double eased(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

double between(double share, double a, double b) { return a + share * (b - a); }

/// By differences ahead, as pbrt takes them.
Vec3d noise_slope(const Vec3d& p) {
  constexpr double step = 0.01;
  const double here = cloud_noise(p);
  return (Vec3d(cloud_noise(p + Vec3d(step, 0, 0)), cloud_noise(p + Vec3d(0, step, 0)),
                cloud_noise(p + Vec3d(0, 0, step))) -
          Vec3d(here, here, here)) /
         step;
}

/// Between two octaves of noise.
constexpr double octave = 1.99;

}  // namespace

double cloud_noise(const Vec3d& p) {
  std::array<size_t, 3> cell{};
  Vec3d within, weight;
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = std::floor(p[axis]);
    within[axis] = p[axis] - whole;
    weight[axis] = eased(within[axis]);
    cell[size_t(axis)] = size_t(whole - double(period) * std::floor(whole / double(period)));
  }
  const auto corner = [&](size_t x, size_t y, size_t z) {
    return along_gradient({cell[0] + x, cell[1] + y, cell[2] + z},
                          within - Vec3d(double(x), double(y), double(z)));
  };
  const auto along_x = [&](size_t y, size_t z) {
    return between(weight.x, corner(0, y, z), corner(1, y, z));
  };
  const auto over_xy = [&](size_t z) { return between(weight.y, along_x(0, z), along_x(1, z)); };
  return between(weight.z, over_xy(0), over_xy(1));
}

double cloud_density(const CloudShape& cloud, const Vec3d& p) {
  // Noise moves the point at which the cloud is looked up.
  Vec3d at = p * cloud.frequency;
  if (cloud.wispiness > 0) {
    constexpr int octaves = 2;
    double shift = 0.05 * cloud.wispiness, scale = 10;
    for (int i = 0; i < octaves; ++i) {
      at += noise_slope(at * scale) * shift;
      shift *= 0.5;
      scale *= octave;
    }
  }
  constexpr int octaves = 5;
  double sum = 0, height = 0.5, scale = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += height * cloud_noise(at * scale);
    height *= 0.5;
    scale *= octave;
  }
  // It gets thinner upward, and below it is filled.
  const double thinned = std::clamp((1 - p.y) * 4.5 * cloud.density * sum, 0.0, 1.0);
  return std::clamp(thinned + 2 * std::max(0.0, 0.5 - p.y), 0.0, 1.0);
}

std::vector<float> cloud_densities(const CloudShape& cloud, const Vec3d& low, const Vec3d& extent,
                                   const std::array<size_t, 3>& cells) {
  std::vector<float> densities(cells[0] * cells[1] * cells[2]);
  parallel_blocks(cells[1] * cells[2], 64, [&](size_t begin, size_t end, size_t) {
    for (size_t row = begin; row < end; ++row)
      for (size_t x = 0; x < cells[0]; ++x) {
        const std::array<size_t, 3> cell = {x, row % cells[1], row / cells[1]};
        Vec3d p = low;
        for (int axis = 0; axis < 3; ++axis) {
          const auto i = size_t(axis);
          p[axis] += (double(cell[i]) + 0.5) / double(cells[i]) * extent[axis];
        }
        densities[row * cells[0] + x] = float(cloud_density(cloud, p));
      }
  });
  return densities;
}

}  // namespace kaustik::pbrt
