#pragma once
// What is known of the surfaces that a picture shows, as denoising asks for it.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kaustik/base/parallel.h"
#include "kaustik/image/image.h"

namespace kaustik {

/// One value per pixel, row by row.
using Plane = std::vector<float>;

/// Calls body(i) for every pixel, in parallel.
template <typename Body>
void for_pixels(size_t count, const Body& body) {
  parallel_blocks(count, 1 << 14, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) body(i);
  });
}

/// A channel, with 0 for what is not finite; zeros where there is none.
Plane plane_of(const Image& image, const std::string& name);

/// The surfaces, without noise.
struct PixelSurfaces {
  explicit PixelSurfaces(const Image& image);

  size_t pixel_count() const { return depth.size(); }

  int width, height;
  std::array<Plane, 3> normal, albedo;
  Plane lightness;     ///< photopic value of the albedo
  Plane depth;         ///< m
  Plane inverse_step;  ///< 1 over 1.5 steps of the depth from pixel to pixel
};

/// A neighbour that every pixel of a row has, but for those too near to the edge.
struct PixelNeighbor {
  int dx, dy;              ///< in the pattern, not yet multiplied by its step
  int begin, end;          ///< the pixels x that have it
  std::ptrdiff_t row;      ///< index of the neighbour of x = 0, were there one
  float inverse_distance;  ///< 1 over its distance in pixels (of the pixel itself: 1)
};

/// Calls visit(neighbor) for those of row y within `reach` steps of `step` pixels.
template <typename Visit>
void for_neighbors(const PixelSurfaces& s, int y, int reach, int step, const Visit& visit) {
  for (int dy = -reach; dy <= reach; ++dy) {
    const int other = y + dy * step;
    if (other < 0 || other >= s.height) continue;
    for (int dx = -reach; dx <= reach; ++dx) {
      const int shift = dx * step, begin = std::max(0, -shift);
      const int end = std::min(s.width, s.width - shift);
      if (begin >= end) continue;
      const float distance = float(step) * std::sqrt(float(dx * dx + dy * dy));
      visit(PixelNeighbor{dx, dy, begin, end, std::ptrdiff_t(other) * s.width + shift,
                          1 / std::max(1.0f, distance)});
    }
  }
}

/// How alike the surfaces of a row's pixels and of their neighbours are, times `share`: 1 if
/// nothing tells them apart, near e^−u by the sum u of what does, 0 from u = 8 on. Writes
/// [neighbor.begin, neighbor.end) of `likeness`.
void tell_likeness(const PixelSurfaces& s, int y, const PixelNeighbor& neighbor, float share,
                   float* likeness);

/// Mean over like surfaces within `reach` pixels on either side.
Plane mean_of_like(const PixelSurfaces& s, const Plane& values, int reach);

}  // namespace kaustik
