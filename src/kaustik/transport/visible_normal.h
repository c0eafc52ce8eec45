#pragma once
#include "kaustik/base/vec.h"

namespace kaustik {

/// `bent`, a normal on the side of the geometric normal `ng`, turned toward that as far as needed
/// for `wo` (on either side) to lie on the same side of both; with `mirrors` also its mirror
/// direction, since light that a bump map sends below the surface would be lost and leave black
/// dots. All unit; continuous in all three. Not the same for both ends of a path, so transport by
/// such normals is symmetric only up to what is seen nearly edge-on.
Vec3f visible_normal(const Vec3f& bent, const Vec3f& ng, const Vec3f& wo, bool mirrors);

}  // namespace kaustik
