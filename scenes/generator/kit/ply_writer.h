#pragma once
#include "kit/mesh.h"

namespace kaustik::scenes {

enum class Normals {
  stored,  ///< in the file
  smooth,  ///< made by whoever loads it, smooth everywhere; for bodies without creases
  flat     ///< of the faces, by `face_normals` in the scene file
};

/// What a mesh file holds beside positions. What differs only by something else becomes one vertex.
struct PlyLayout {
  Normals normals = Normals::stored;
  bool uvs = false;
};

/// Binary PLY, little-endian. Positions are rounded to 2^-16 m and normals to 2^-10, so that the
/// last bits of the machine's sine don't show in the file. Triangles that rounding has made
/// degenerate are left out.
std::vector<uint8_t> ply_bytes(const Mesh& mesh, const PlyLayout& layout);

}  // namespace kaustik::scenes
