#pragma once
#include <functional>

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// Triangles of the surface where `value` is zero (marching tetrahedra), flat and facing where it
/// is positive. It is asked at the corners of cells³ cells between `low` and `high`, in the order
/// x, y, z; the result lies in the world.
TriangleMesh zero_set(const std::function<double(const Vec3d&)>& value, const Vec3d& low,
                      const Vec3d& high, int cells, const Transform& world_from_field);

/// Of all triangles.
double mesh_area(const TriangleMesh& mesh);

}  // namespace kaustik
