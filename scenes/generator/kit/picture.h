#pragma once
// Pictures for the walls, painted by programs.

#include <vector>

#include "kit/mesh.h"

namespace kaustik::scenes {

/// Colours as on a screen (sRGB, 0 … 1), row by row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<Vec3d> pixels;

  /// Each pixel from its place: x to the right, y upward, the shorter side 0 … 1; the mean of
  /// 3 x 3 samples.
  static Picture painted(int width, int height,
                         const std::function<Vec3d(double x, double y)>& color);
};

/// Binary PPM of 8 bits.
std::vector<uint8_t> ppm_bytes(const Picture& picture);

Vec3d mixed(const Vec3d& a, const Vec3d& b, double t);
/// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double x);

// Subjects. `width` x `height` are pixels, the seed changes the picture.
Picture mountain_lake(int width, int height, uint64_t seed);
Picture color_fields(int width, int height, uint64_t seed);
Picture geometric_composition(int width, int height, uint64_t seed);
Picture seascape_at_dusk(int width, int height, uint64_t seed);
Picture still_life(int width, int height, uint64_t seed);

}  // namespace kaustik::scenes
