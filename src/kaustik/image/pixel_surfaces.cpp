#include "kaustik/image/pixel_surfaces.h"

#include <algorithm>

#include "kaustik/base/spectrum.h"
#include "kaustik/base/vectorize.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

// Surfaces are unlike by the sum of three terms, each 1 where the weight falls to 1/e:
/// the squared difference of the unit normals,
constexpr float normal_tolerance_sq = 0.05f;
/// the photopic albedo,
constexpr float albedo_tolerance = 0.15f;
/// the distance from the plane, in steps of the depth from pixel to pixel.
constexpr float plane_tolerance = 1.5f;

/// Near e^−x for x ≥ 0 and zero from 8 on; compilers make vectors of it.
inline float falloff(float x) {
  float y = std::max(0.0f, 1.0f - 0.125f * x);
  y *= y;
  y *= y;
  return y * y;
}

Plane inverse_steps(const Plane& depths, int width, int height) {
  const auto depth = [&](int x, int y) { return depths[size_t(y) * size_t(width) + size_t(x)]; };
  const auto step_to = [&](int x, int y, int dx, int dy) {
    const bool inside = x + dx >= 0 && y + dy >= 0 && x + dx < width && y + dy < height;
    return inside ? std::fabs(depth(x, y) - depth(x + dx, y + dy)) : infinity;
  };
  Plane result(depths.size());
  parallel_blocks(size_t(height), 16, [&](size_t first, size_t last, size_t) {
    for (int y = int(first); y < int(last); ++y)
      for (int x = 0; x < width; ++x) {
        // The lesser of both sides: beyond an outline is another surface.
        const float across = std::min(step_to(x, y, -1, 0), step_to(x, y, 1, 0));
        const float down = std::min(step_to(x, y, 0, -1), step_to(x, y, 0, 1));
        float step = 1e-3f * std::fabs(depth(x, y)) + 1e-12f;  // rounding, and curved surfaces
        for (const float side : {across, down})
          if (std::isfinite(side)) step = std::max(step, side);
        result[size_t(y) * size_t(width) + size_t(x)] = 1 / (plane_tolerance * step);
      }
  });
  return result;
}

}  // namespace

Plane plane_of(const Image& image, const std::string& name) {
  const int channel = image.find_channel(name);
  if (channel < 0) return Plane(image.pixel_count());
  const auto values = image.channel(channel);
  Plane plane(values.size());
  for_pixels(plane.size(),
             [&](size_t i) { plane[i] = std::isfinite(values[i]) ? values[i] : 0.0f; });
  return plane;
}

PixelSurfaces::PixelSurfaces(const Image& image)
    : width(image.width()), height(image.height()), depth(plane_of(image, "depth.Z")) {
  for (size_t k = 0; k < 3; ++k) {
    normal[k] = plane_of(image, std::string("N.") + "XYZ"[k]);
    albedo[k] = plane_of(image, std::string("albedo.") + "RGB"[k]);
  }
  lightness.resize(depth.size());
  for_pixels(depth.size(), [&](size_t i) {
    lightness[i] = photopic({albedo[0][i], albedo[1][i], albedo[2][i]});
  });
  inverse_step = inverse_steps(depth, width, height);
}

void tell_likeness(const PixelSurfaces& s, int y, const PixelNeighbor& neighbor, float share,
                   float* likeness) {
  const std::ptrdiff_t here = std::ptrdiff_t(y) * s.width;
  const float *nx = s.normal[0].data() + here, *ny = s.normal[1].data() + here;
  const float *nz = s.normal[2].data() + here, *lightness = s.lightness.data() + here;
  const float *depth = s.depth.data() + here, *inverse_step = s.inverse_step.data() + here;
  const float* other_nx = s.normal[0].data() + neighbor.row;
  const float* other_ny = s.normal[1].data() + neighbor.row;
  const float* other_nz = s.normal[2].data() + neighbor.row;
  const float* other_lightness = s.lightness.data() + neighbor.row;
  const float* other_depth = s.depth.data() + neighbor.row;
  const float inverse_distance = neighbor.inverse_distance;
  KAUSTIK_INDEPENDENT_TURNS
  for (int x = neighbor.begin; x < neighbor.end; ++x) {
    const float dx = nx[x] - other_nx[x], dy = ny[x] - other_ny[x], dz = nz[x] - other_nz[x];
    const float unlikeness =
        (dx * dx + dy * dy + dz * dz) * (1 / normal_tolerance_sq) +
        std::fabs(lightness[x] - other_lightness[x]) * (1 / albedo_tolerance) +
        std::fabs(depth[x] - other_depth[x]) * inverse_step[x] * inverse_distance;
    likeness[x] = share * falloff(unlikeness);
  }
}

Plane mean_of_like(const PixelSurfaces& s, const Plane& values, int reach) {
  Plane result(values.size());
  const auto width = size_t(s.width);
  parallel_blocks(size_t(s.height), 4, [&](size_t first, size_t last, size_t) {
    Plane like_row(width), weight_row(width), sum_row(width);
    float *like = like_row.data(), *weights = weight_row.data(), *sums = sum_row.data();
    for (size_t y = first; y < last; ++y) {
      std::fill(weight_row.begin(), weight_row.end(), 0.0f);
      std::fill(sum_row.begin(), sum_row.end(), 0.0f);
      for_neighbors(s, int(y), reach, 1, [&](const PixelNeighbor& n) {
        tell_likeness(s, int(y), n, 1, like);
        const float* from = values.data() + n.row;
        KAUSTIK_INDEPENDENT_TURNS
        for (int x = n.begin; x < n.end; ++x) {
          weights[x] += like[x];
          sums[x] += like[x] * from[x];
        }
      });
      for (size_t x = 0; x < width; ++x)
        if (weights[x] > 0) result[y * width + x] = sums[x] / weights[x];
    }
  });
  return result;
}

}  // namespace kaustik
