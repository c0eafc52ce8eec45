#pragma once
// Signed distance fields of the `sdf` shape, in their own space: the cube [-1, 1]³.

#include "kaustik/base/vec.h"

namespace kaustik {

enum class SdfKind { menger, mandelbulb };

struct SdfField {
  SdfKind kind = SdfKind::menger;
  int iterations = 4;

  /// Positive outside, never more than the distance to the surface there; negative inside, where
  /// only the sign is certain unless knows_depth().
  double value(const Vec3d& p) const;
  /// Whether the value is never more than the distance to the surface inside, too.
  bool knows_depth() const { return kind == SdfKind::menger; }
  /// Direction in which the value grows fastest, unit.
  Vec3d gradient(const Vec3d& p) const;
};

}  // namespace kaustik
