#pragma once
// What the sources of SurfaceMaker share.

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/base/vec.h"
#include "kaustik/loader/radiance/statements.h"

namespace kaustik::radiance {

/// Throws Error(input) for another count.
inline void need_reals(const Primitive& primitive, size_t count) {
  if (primitive.reals.size() == count) return;
  throw Error(ErrorKind::input,
              fmt::format("{} has {} numbers where {} are needed", name_of(primitive),
                          primitive.reals.size(), count),
              "correct the arguments, and the counts before them", primitive.place);
}

inline Vec3d vector_at(const Primitive& primitive, size_t first) {
  return {primitive.reals[first], primitive.reals[first + 1], primitive.reals[first + 2]};
}

/// Twice the area of a polygon along its normal (Newell).
inline Vec3d area_vector_of(const std::vector<Vec3d>& corners) {
  Vec3d sum(0, 0, 0);
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return sum;
}

/// What is beyond floats, or would be lost in them.
inline bool is_usable(const Vec3d& point) {
  return std::fabs(point.x) < 1e12 && std::fabs(point.y) < 1e12 && std::fabs(point.z) < 1e12;
}

/// Two unit vectors across an axis.
inline std::pair<Vec3d, Vec3d> across(const Vec3d& axis) {
  const Vec3d other = std::fabs(axis.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d u = other.cross(axis).normalized();
  return {u, axis.cross(u)};
}

}  // namespace kaustik::radiance
