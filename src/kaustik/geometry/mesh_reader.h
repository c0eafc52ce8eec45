#pragma once
#include <optional>

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

/// Which faces of an OBJ file are read.
struct ObjSelection {
  /// Those of one of the parts that lines `g` and `usemtl` divide it into, counted from 0.
  std::optional<uint64_t> shape_index = {};
  /// Those of one material; "": those before any `usemtl`.
  std::optional<std::string> material = {};
};
/// Wavefront OBJ: v (with colours), vt, vn and f, in small or capital letters; smoothing, points
/// and lines are skipped, what it does not know is remarked. Vertices are split where texture
/// coordinates or normals differ.
MeshFile read_obj(const std::string& path, const ObjSelection& selection = {});

/// Mitsuba's packed meshes, versions 3 to 5: the one with this index of those that a file holds.
/// Colours of versions 3 and 4 are the attribute "vertex_color"; attributes of version 5 are
/// skipped.
MeshFile read_serialized(const std::string& path, uint64_t shape_index);

/// Reads the file of a shape of type `obj`, `ply` or `serialized`, as much of it as the arguments
/// select, or the buffers of a `mesh`; nothing for other types.
std::optional<MeshFile> read_mesh_file(const Arguments& arguments);
/// The same with all done to it that other programs cannot: `flip_tex_coords` has been applied, and
/// vertices without a normal have one if others do. With `max_smooth_angle` it has the normals of
/// that and is placed by `to_world`, which then must not be applied again. Flat meshes have no
/// normals. `to_world` otherwise, `face_normals` and `flip_normals` are still to be applied.
MeshFile unplaced_mesh(const Arguments& arguments);

/// The remark on faces with fewer than three corners.
std::string remark_on_small_faces(size_t count, const std::string& file);

}  // namespace kaustik
