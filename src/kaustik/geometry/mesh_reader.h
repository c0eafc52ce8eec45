#pragma once
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// Reads a mesh file in its own space. Polygons become fans of triangles; normals are as in the
/// file (any length, zero where the file gives none). Whatever the bytes are, the result is a mesh
/// with consistent sizes, indices in range and finite coordinates, or Error(input) is thrown that
/// names the file, the place and what to do.
TriangleMesh read_ply(const std::string& path);
/// Wavefront OBJ: v, vt, vn and f; groups, materials and smoothing are skipped. Vertices are split
/// where texture coordinates or normals differ.
TriangleMesh read_obj(const std::string& path);

}  // namespace kaustik
