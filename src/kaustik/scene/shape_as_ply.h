#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// A mesh for programs that do not read what Kaustik reads.
struct ShapeAsPly {
  std::vector<uint8_t> file;
  bool is_flat = false;  ///< whether its file says that it has flat faces
};

/// The mesh of a shape of type `obj`, `ply`, `serialized` or `heightfield` as a PLY file, in the
/// shape's own space, or in the world where it has `max_smooth_angle` and no `face_normals`. A
/// shape `ply` of that file with the same `to_world` (none in the world), `flip_normals` and
/// `face_normals` (`shading_normals` turned round) is the same as `shape`. Throws Error(input) for
/// what build_scene() would refuse.
ShapeAsPly shape_as_ply(const Object& shape);

}  // namespace kaustik
