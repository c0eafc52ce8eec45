#pragma once
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// A sphere whose outside is its front; `radius` above 0.
std::unique_ptr<Shape> make_sphere(const Vec3d& center, double radius);

}  // namespace kaustik
