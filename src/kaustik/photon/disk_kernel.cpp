#include "kaustik/photon/disk_kernel.h"

#include <algorithm>
#include <cmath>

namespace kaustik {
namespace {

constexpr size_t direction_count = 64;

struct Direction {
  float x, y;
};
const std::array<Direction, direction_count>& directions() {
  static const auto table = [] {
    std::array<Direction, direction_count> result;
    for (size_t i = 0; i < direction_count; ++i) {
      const float angle = 2 * pi * (float(i) + 0.5f) / float(direction_count);
      result[i] = {std::cos(angle), std::sin(angle)};
    }
    return result;
  }();
  return table;
}

/// ∫ shape(r) rⁿ⁺¹ dr from 0 to `reach`, n = 0, 1, 2.
struct RadialMoments {
  float zeroth, first, second;
};
RadialMoments radial_moments(float reach, KernelShape shape) {
  const float r2 = reach * reach, r3 = r2 * reach, r4 = r2 * r2;
  if (shape == KernelShape::flat) return {r2 / 2, r3 / 3, r4 / 4};
  return {r2 / 2 - r4 / 4, r3 / 3 - r4 * reach / 5, r4 / 4 - r4 * r2 / 6};
}

}  // namespace

DiskMoments disk_moments(const Frame& frame, float radius, const DiskEdges& edges,
                         KernelShape shape) {
  struct Line {
    float x, y, distance;
  };
  std::array<Line, DiskEdges::most> lines;
  size_t count = 0;
  for (size_t i = 0; i < edges.count; ++i) {
    const DiskEdges::Edge& edge = edges.edges[i];
    if (edge.distance < radius)
      lines[count++] = {-dot(edge.inward, frame.x), -dot(edge.inward, frame.y),
                        edge.distance / radius};
  }
  const RadialMoments whole = radial_moments(1, shape);
  if (count == 0) {
    const double second = double(pi * whole.second);
    return {double(2 * pi * whole.zeroth), 0, 0, second, 0, second};
  }
  // What is left is convex: in each direction it reaches from the center to the first line.
  DiskMoments result;
  for (const Direction& d : directions()) {
    float reach = 1;
    for (size_t i = 0; i < count; ++i) {
      const float cosine = d.x * lines[i].x + d.y * lines[i].y;
      if (cosine * reach > lines[i].distance) reach = lines[i].distance / cosine;
    }
    const RadialMoments radial = radial_moments(reach, shape);
    result.one += double(radial.zeroth);
    result.x += double(d.x * radial.first);
    result.y += double(d.y * radial.first);
    result.xx += double(d.x * d.x * radial.second);
    result.xy += double(d.x * d.y * radial.second);
    result.yy += double(d.y * d.y * radial.second);
  }
  constexpr double step = 2 * double(pi) / double(direction_count);
  for (double* sum : {&result.one, &result.x, &result.y, &result.xx, &result.xy, &result.yy})
    *sum *= step;
  return result;
}

DiskKernel::DiskKernel(const Frame& frame, float radius, const DiskEdges& edges,
                       KernelShape shape) {
  const DiskMoments m = disk_moments(frame, radius, edges, shape);
  const auto unit_scale = [&] { return float(1 / (m.one * double(radius) * double(radius))); };
  if (!edges.cut(radius)) {
    scale = unit_scale();
    return;
  }
  // a + b · p with ∫ (a + b · p) = 1 and ∫ p (a + b · p) = 0.
  const double determinant = m.xx * m.yy - m.xy * m.xy;
  if (!(determinant > 0)) {
    scale = unit_scale();
    return;
  }
  const double bx = -(m.yy * m.x - m.xy * m.y) / determinant;
  const double by = -(m.xx * m.y - m.xy * m.x) / determinant;
  scale = float(1 / ((m.one + bx * m.x + by * m.y) * double(radius) * double(radius)));
  slope = (frame.x * float(bx) + frame.y * float(by)) * (1 / radius);
}

}  // namespace kaustik
