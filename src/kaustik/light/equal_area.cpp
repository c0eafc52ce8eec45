#include "kaustik/light/equal_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/base/parallel.h"
#include "kaustik/base/vec.h"

namespace kaustik {
namespace {

/// Points in each pixel, along both sides.
constexpr int points = 4;

/// Where on the unit square a direction lies whose third coordinate is the middle's; the inverse of
/// Clarberg's map of the square to the sphere.
Imath::V2d square_from(const Vec3d& d) {
  const double x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  // Over the square's own diamond: r from its middle, and the share of a quarter turn.
  const double r = std::sqrt(std::max(0.0, 1 - z));
  const double turn = std::atan2(y, x) * (2 / std::numbers::pi);
  double v = turn * r, u = r - v;
  if (d.z < 0) {
    const double mirrored = 1 - v;
    v = 1 - u;
    u = mirrored;
  }
  return {0.5 * (1 + std::copysign(u, d.x)), 0.5 * (1 + std::copysign(v, d.y))};
}

}  // namespace

Image latlong_of_equal_area(const Image& square) {
  const int size = square.width();
  Image result(2 * size, std::max(size, 2), square.channel_names());
  const int width = result.width(), rows = result.height();
  parallel_blocks(size_t(rows), 4, [&](size_t begin, size_t end, size_t) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < width; ++x) {
        const size_t pixel = size_t(y) * size_t(width) + size_t(x);
        for (int c = 0; c < result.channel_count(); ++c) result.channel(c)[pixel] = 0;
        for (int i = 0; i < points * points; ++i) {
          // Rows lie at nodes of the latitude, columns between those of the longitude.
          const double across = (x + (i % points + 0.5) / points) / width;
          const double down = (y + (i / points + 0.5) / points - 0.5) / (rows - 1);
          const double phi = 2 * std::numbers::pi * across;
          const double theta = std::numbers::pi * std::clamp(down, 0.0, 1.0);
          const Vec3d d(std::sin(theta) * std::sin(phi), std::cos(theta),
                        -std::sin(theta) * std::cos(phi));
          const Imath::V2d at = square_from({d.x, -d.z, d.y});
          const int column = std::clamp(int(at.x * size), 0, size - 1);
          const int row = std::clamp(int(at.y * size), 0, size - 1);
          const size_t from = size_t(row) * size_t(size) + size_t(column);
          for (int c = 0; c < result.channel_count(); ++c)
            result.channel(c)[pixel] += square.channel(c)[from] * (1.0f / (points * points));
        }
      }
  });
  return result;
}

}  // namespace kaustik
