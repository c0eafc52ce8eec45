#include "kaustik/base/polygon_cutter.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/ear_clipper.h"

namespace kaustik {
namespace {

using Positions = std::span<const Vec3f>;
using Corners = std::span<const uint32_t>;

/// Of the triangle from corner `a` to `b` to `c`: twice its area.
Vec3d area_vector(Positions p, uint32_t a, uint32_t b, uint32_t c) {
  const Vec3d from(p[a]);
  return (Vec3d(p[b]) - from).cross(Vec3d(p[c]) - from);
}

void add_fan(Corners names, PolygonCutter::Triangles& triangles) {
  for (size_t i = 2; i < names.size(); ++i) triangles.push_back({names[0], names[i - 1], names[i]});
}

/// By the first diagonal, unless the halves lie over one another so, and not by the second one.
void add_quad(Positions p, Corners c, Corners names, PolygonCutter::Triangles& triangles) {
  const auto agree = [&](size_t i) {
    const uint32_t a = c[i], b = c[(i + 1) % 4], across = c[(i + 2) % 4], d = c[(i + 3) % 4];
    return area_vector(p, a, b, across).dot(area_vector(p, a, across, d)) >= 0;
  };
  if (agree(0) || !agree(1)) return add_fan(names, triangles);
  triangles.push_back({names[1], names[2], names[3]});
  triangles.push_back({names[1], names[3], names[0]});
}

/// Some normal of the polygon: its area vector, or, where lobes cancel in that, that of its largest
/// triangle at the first corner. Zero if it has no area.
Vec3d normal_of(Positions p, Corners c) {
  Vec3d sum(0, 0, 0), largest(0, 0, 0);
  double total = 0;
  for (size_t i = 2; i < c.size(); ++i) {
    const Vec3d area = area_vector(p, c[0], c[i - 1], c[i]);
    sum += area;
    total += area.length();
    if (area.length2() > largest.length2()) largest = area;
  }
  return sum.length() > 1e-9 * total ? sum : largest;
}

/// The polygon as seen against its normal, anticlockwise if its area vector is `normal`.
std::vector<Vec2d> flattened(Positions p, Corners c, const Vec3d& normal) {
  const Vec3d unit = normal.normalized(), first(p[c[0]]);
  double extent = 0, depth = 0;
  for (const uint32_t corner : c) {
    const Vec3d d = Vec3d(p[corner]) - first;
    extent = std::max(extent, d.length());
    depth = std::max(depth, std::fabs(d.dot(unit)));
  }
  std::vector<Vec2d> flat;
  flat.reserve(c.size());
  int k = 0;
  for (const int axis : {1, 2})
    if (std::fabs(unit[axis]) > std::fabs(unit[k])) k = axis;
  int i = (k + 1) % 3, j = (k + 2) % 3;
  if (unit[k] < 0) std::swap(i, j);
  if (depth <= 1e-5 * extent) {
    // Seen along an axis the coordinates stay as they are: corners on a line stay on a line.
    for (const uint32_t corner : c) flat.emplace_back(double(p[corner][i]), double(p[corner][j]));
    return flat;
  }
  Vec3d x(0, 0, 0);
  x[i] = 1;
  x = (x - unit * unit.dot(x)).normalized();
  const Vec3d y = unit.cross(x);
  for (const uint32_t corner : c) {
    const Vec3d d = Vec3d(p[corner]) - first;
    flat.emplace_back(d.dot(x), d.dot(y));
  }
  return flat;
}

/// Whether it turns left everywhere, once round; straight on is left, back is not.
bool is_convex(const std::vector<Vec2d>& flat) {
  const size_t n = flat.size();
  int turns = 0;  // between going right and going left
  const auto goes_right = [](const Vec2d& d) { return d.x > 0 || (d.x == 0 && d.y > 0); };
  for (size_t i = 0; i < n; ++i) {
    const Vec2d &a = flat[i], &b = flat[(i + 1) % n], &c = flat[(i + 2) % n];
    const int side = side_of(a, b, c);
    if (side < 0 || (side == 0 && (b - a).dot(c - b) <= 0)) return false;
    if (goes_right(b - a) != goes_right(c - b)) ++turns;
  }
  return turns <= 2;
}

}  // namespace

bool PolygonCutter::cut(Positions positions, Corners corners, Corners names, Triangles& triangles) {
  // More than once round all of them, there and back: no polygon, but work without end.
  if (corners.size() > 2 * positions.size() + 4) return false;
  if (corners.size() == 4) {
    add_quad(positions, corners, names, triangles);
    return true;
  }
  const Vec3d normal = corners.size() > 3 ? normal_of(positions, corners) : Vec3d(0, 0, 0);
  if (normal == Vec3d(0, 0, 0)) {
    add_fan(names, triangles);
    return true;
  }
  const std::vector<Vec2d> flat = flattened(positions, corners, normal);
  if (is_convex(flat)) {
    add_fan(names, triangles);
    return true;
  }
  EarClipper clipper(flat, steps_);
  const bool complete = clipper.clip();
  for (const auto& [a, b, c] : clipper.triangles())
    triangles.push_back({names[a], names[b], names[c]});
  return complete;
}

}  // namespace kaustik
