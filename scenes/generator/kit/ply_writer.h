#pragma once
#include "kit/mesh.h"

namespace kaustik::scenes {

/// What a mesh file holds beside positions. Without normals it is meant to be loaded with
/// `face_normals`, and what only differed by them becomes one vertex.
struct PlyLayout {
  bool normals = true;
  bool uvs = false;
};

/// Binary PLY, little-endian. Positions are rounded to 2^-16 m and normals to 2^-10, so that the
/// last bits of the machine's sine don't show in the file. Triangles that rounding has made
/// degenerate are left out.
std::vector<uint8_t> ply_bytes(const Mesh& mesh, const PlyLayout& layout);

}  // namespace kaustik::scenes
