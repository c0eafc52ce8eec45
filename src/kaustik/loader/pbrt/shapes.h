#pragma once
// Shapes of pbrt as meshes and bodies.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/loader/pbrt/described.h"
#include "kaustik/loader/pbrt/parameters.h"
#include "kaustik/loader/pbrt/scene_files.h"

namespace kaustik::pbrt {

/// A mesh as it is built; three numbers for a vertex, two for its uv.
struct MeshParts {
  std::vector<float> positions, normals, uv;
  std::vector<int32_t> faces;

  size_t bytes() const {
    return sizeof(float) * (positions.size() + normals.size() + uv.size() + faces.size());
  }
};

inline void append(std::vector<float>& numbers, const Vec3d& v) {
  numbers.insert(numbers.end(), {float(v.x), float(v.y), float(v.z)});
}

/// What makers of shapes work with.
struct ShapeTools : Subject {
  SceneFiles& files;
  const ParameterList& list;
  const Transform& to_world;
  bool is_flipped = false;   ///< ReverseOrientation
  bool is_textured = false;  ///< uv may matter
  /// How many shapes pbrt makes of it, each a lamp of its own: the triangles of a mesh, patches.
  mutable size_t lamps = 1;
};

/// All but curves. Null: it is left out, which is told.
std::shared_ptr<Object> make_shape(const ShapeTools& tools, const std::string& type);

std::shared_ptr<Object> make_sphere(const ShapeTools& tools);
std::shared_ptr<Object> make_cylinder(const ShapeTools& tools);
std::shared_ptr<Object> make_disk(const ShapeTools& tools);
std::shared_ptr<Object> make_cone(const ShapeTools& tools);
std::shared_ptr<Object> make_paraboloid(const ShapeTools& tools);
std::shared_ptr<Object> make_hyperboloid(const ShapeTools& tools);
std::shared_ptr<Object> make_heightfield(const ShapeTools& tools);
std::shared_ptr<Object> make_ply(const ShapeTools& tools);
std::shared_ptr<Object> make_triangles(const ShapeTools& tools);
std::shared_ptr<Object> make_bilinear_patches(const ShapeTools& tools);
std::shared_ptr<Object> make_subdivided(const ShapeTools& tools);

/// Appends a curve, in the space of `to_world`, as a tube or a ribbon.
void add_curve(const ShapeTools& tools, MeshParts& mesh);

inline constexpr int steps_around = 96, steps_along = 48;
/// The angle of 'phimax', in radians.
double turn_of(const ShapeTools& tools);
/// Steps round so much of a turn.
int steps_for(double turn);
/// Points and normals over u and v from 0 to 1; the front is where u × v points.
struct SurfacePart {
  std::function<Vec3d(double u, double v)> point, normal;
  int along_u = steps_around, along_v = steps_along;
};
std::shared_ptr<Object> meshed(const ShapeTools& tools, const SurfacePart& part);
/// Two triangles for each cell of a grid of vertices that begins at `first`, row by row.
void append_cells(std::vector<int32_t>& faces, int32_t first, int32_t across, int32_t up);

/// A shape of the mesh, in the space of `to_world`.
std::shared_ptr<Object> shape_of(MeshParts mesh, const Place& place);
/// With to_world, and the side that the file says.
std::shared_ptr<Object> placed(std::shared_ptr<Object> shape, const ShapeTools& tools);

/// Vertices, three numbers each. Throws Error(input) if there are none.
std::shared_ptr<std::vector<float>> vertices_of(const ParameterList& list);
/// Indices in tuples of that size, of so many vertices; without any those of a single face. Throws
/// Error(input) for what is none.
std::shared_ptr<std::vector<int32_t>> indices_of(const ParameterList& list, size_t tuple,
                                                 size_t vertices);

/// Three numbers for each vertex and normal, two for its uv, three for each face. What the mesh
/// does not have is empty.
struct MeshBuffers {
  std::span<const float> positions, normals, uv;
  std::span<const int32_t> faces;
};
/// Those that a shape of type "mesh" holds; nothing: it is none.
std::optional<MeshBuffers> buffers_of(const Object& shape);

/// Loop's subdivision (Loop, "Smooth Subdivision Surfaces Based on Triangles", 1987), with points
/// and normals at their limits.
MeshParts subdivided(const std::vector<float>& positions, const std::vector<int32_t>& faces,
                     int levels);

}  // namespace kaustik::pbrt
