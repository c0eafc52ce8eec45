#pragma once
#include <span>

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// What a mesh file holds.
struct MeshFile {
  TriangleMesh mesh;
  /// What was left out, for the user: a sentence each, with the file's name.
  std::vector<std::string> remarks = {};
  bool has_face_normals = false;  ///< whether it is to have flat faces
};

/// Reads a mesh file in its own space. Polygons are cut by PolygonCutter; normals are as in the
/// file (any length, zero where the file gives none). Faces with fewer than three corners are left
/// out. Properties that go together are attributes (attribute_groups()). Whatever the bytes are,
/// the result is a mesh with consistent sizes, indices in range and finite coordinates, or
/// Error(input) is thrown that names the file, the place and what to do; it takes time in
/// proportion to their number.
MeshFile read_ply(const std::string& path);
/// Wavefront OBJ: v (with colours), vt, vn and f, in small or capital letters; groups, materials,
/// smoothing, points and lines are skipped, what it does not know is remarked. Vertices are split
/// where texture coordinates or normals differ.
MeshFile read_obj(const std::string& path);

/// Mitsuba's packed meshes, versions 3 and 4: the one with this index of those that a file holds.
/// Colours are the attribute "vertex_color".
MeshFile read_serialized(const std::string& path, uint64_t shape_index);

/// How many bytes of `bytes` are a mark that it is UTF-8 text. Throws Error(input) naming `file`
/// where the mark of another encoding stands.
size_t byte_order_mark(std::span<const uint8_t> bytes, const std::string& file);
/// The remark on faces with fewer than three corners.
std::string remark_on_small_faces(size_t count, const std::string& file);

}  // namespace kaustik
