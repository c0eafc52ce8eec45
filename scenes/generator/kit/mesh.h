#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik::scenes {

using Vec2d = Imath::V2d;

inline constexpr double pi_d = std::numbers::pi;

struct Vertex {
  Vec3d position;      ///< metres
  Vec3d normal{0.0};   ///< unit length, or zero where there is none yet
  Vec2d uv{0.0, 0.0};  ///< texture coordinates
};

/// Indexed triangles, counterclockwise seen from outside. Seams of texture coordinates and creases
/// repeat a position; what touches has bitwise equal positions, so that `welded` can tell.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;

  uint32_t add(const Vec3d& position, const Vec2d& uv = {0.0, 0.0});
  void triangle(uint32_t a, uint32_t b, uint32_t c) { triangles.push_back({a, b, c}); }
  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  void append(const Mesh& other);
  Vec3d corner(size_t face, int k) const { return vertices[triangles[face][size_t(k)]].position; }
  /// (b - a) x (c - a): twice the area long, pointing outward.
  Vec3d cross_of(size_t face) const;
};

using Map3 = std::function<Vec3d(const Vec3d&)>;

// Each returns a changed copy; they chain as in `moved(turned(box, …), …)`.
Mesh moved(Mesh mesh, const Vec3d& offset);
/// Right-handed turn about an axis through the origin.
Mesh turned(Mesh mesh, const Vec3d& axis, double degrees);
/// Factors may be negative; the surface keeps its outside. None may be zero.
Mesh scaled(Mesh mesh, const Vec3d& factors);
/// Moves positions by `map`; normals are dropped (see `shaded`).
Mesh bent(Mesh mesh, const Map3& map);
Mesh turned_inside_out(Mesh mesh);
Mesh merged(const std::vector<Mesh>& parts);
/// Height of its lowest vertex, m.
double lowest(const Mesh& mesh);

/// Each triangle in four, at the middles of its edges; normals are dropped.
Mesh subdivided(Mesh mesh);
/// Positions moved along the smooth normal by `height(position)` metres; normals are dropped.
Mesh displaced(Mesh mesh, const std::function<double(const Vec3d&)>& height);

/// Normals: the mean of the neighbouring faces weighted by their angles, over edges that turn by
/// less than `crease_degrees`; vertices are split along sharper ones. 0 gives flat faces, 180 a
/// smooth surface.
Mesh shaded(const Mesh& mesh, double crease_degrees);

/// uv = metres / `metres_per_repeat`, projected along the axis that the face looks at most;
/// vertices are split where the axis changes. Normals stay.
Mesh box_mapped(const Mesh& mesh, double metres_per_repeat);

/// Index of the first vertex at the same place, per vertex.
std::vector<uint32_t> welded(const Mesh& mesh);

struct MeshReport {
  bool closed = true;       ///< every edge has as many faces on its one side as on its other
  double volume = 0;        ///< m³ enclosed; negative when the mesh is inside out
  size_t degenerate = 0;    ///< triangles without an area
  bool uv_in_range = true;  ///< all texture coordinates in [0, 1]
  bool normals_face_outward = true;  ///< each vertex normal on the outer side of its faces
};
MeshReport inspect(const Mesh& mesh);

}  // namespace kaustik::scenes
