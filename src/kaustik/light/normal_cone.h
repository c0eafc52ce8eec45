#pragma once
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// The directions within an angle of an axis.
struct DirectionCone {
  Vec3f axis{0, 0, 1};
  float cos_angle = -1;  ///< −1: every direction
};

/// A cone that holds every geometric normal of a shape; every direction where none is known.
DirectionCone cone_of_normals(const Shape& shape);

}  // namespace kaustik
