#pragma once
#include <array>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Three vectors that are not in a plane, and those that take sums of them apart: vector i times
/// dual j is 1 if i = j, otherwise 0.
struct LinearMap {
  std::array<Vec3d, 3> columns, duals;

  explicit LinearMap(const std::array<Vec3d, 3>& of) : columns(of) {
    const double determinant = of[0].cross(of[1]).dot(of[2]);
    for (size_t i = 0; i < 3; ++i) duals[i] = of[(i + 1) % 3].cross(of[(i + 2) % 3]) / determinant;
  }

  Vec3d apply(const Vec3d& v) const {
    return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
  }
  Vec3d undo(const Vec3d& v) const { return {v.dot(duals[0]), v.dot(duals[1]), v.dot(duals[2])}; }
  /// Of a plane's normal before: that of the plane after; not normalised.
  Vec3d normal(const Vec3d& n) const { return duals[0] * n.x + duals[1] * n.y + duals[2] * n.z; }
  double determinant() const { return columns[0].cross(columns[1]).dot(columns[2]); }
};

}  // namespace kaustik
