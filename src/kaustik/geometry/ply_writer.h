#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// The mesh as a binary PLY file, little endian, of single floats: positions, normals and texture
/// coordinates where it has them, attributes as attribute_groups() finds them again, triangles.
/// read_ply() gives the same bits.
std::vector<uint8_t> ply_file_of(const TriangleMesh& mesh);

}  // namespace kaustik
