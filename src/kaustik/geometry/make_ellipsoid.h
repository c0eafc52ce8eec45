#pragma once
#include <array>

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// The points center + x axes[0] + y axes[1] + z axes[2] with x² + y² + z² = 1; the axes of any
/// lengths and at any angles. `flipped`: the inside is the front. Throws Error(input) at `place` if
/// it is thinner than `smallest_length`.
std::unique_ptr<Shape> make_ellipsoid(const Vec3d& center, const std::array<Vec3d, 3>& axes,
                                      bool flipped, const Place& place);

}  // namespace kaustik
