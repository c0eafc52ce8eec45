#include "kaustik/light/normal_cone.h"

namespace kaustik {
namespace {

constexpr int probes = 64;

/// Point `i` of a small (0,2)-net-like set (the lattice of the plastic number, Roberts 2018).
Vec2f probe(int i) {
  const double a = 0.7548776662466927, b = 0.5698402909980532;
  const double x = 0.5 + a * i, y = 0.5 + b * i;
  return {float(x - std::floor(x)), float(y - std::floor(y))};
}

/// Twice the area vector of a triangle in the order of its corners.
Vec3f area_vector(const TriangleMesh& mesh, size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
}

/// +1 where normals follow the order of the corners, −1 where they oppose it, 0 where neither holds
/// for all the probes.
int winding_sign(const Shape& shape, const TriangleMesh& mesh) {
  int agree = 0, oppose = 0;
  for (int i = 0; i < probes; ++i) {
    const ShapeSample s = shape.sample_area(probe(i));
    if (s.point.primitive >= mesh.triangles.size()) return 0;
    (dot(s.point.ng, area_vector(mesh, s.point.primitive)) > 0 ? agree : oppose)++;
  }
  return oppose == 0 ? 1 : agree == 0 ? -1 : 0;
}

DirectionCone cone_of_triangles(const Shape& shape, const TriangleMesh& mesh) {
  const int sign = winding_sign(shape, mesh);
  if (sign == 0) return {};
  Vec3f sum(0, 0, 0);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) sum += area_vector(mesh, i);
  if (!(length_sq(sum) > 0)) return {};
  DirectionCone cone{normalize(sum) * float(sign), 1};
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3f v = area_vector(mesh, i) * float(sign);
    if (length_sq(v) > 0)
      cone.cos_angle = std::min(cone.cos_angle, dot(cone.axis, v) / length(v) - 1e-6f);
  }
  return cone.cos_angle > -1 ? cone : DirectionCone{};
}

/// Analytic shapes that can be sampled are quadrics: one whose normals are equal at many points is
/// flat.
DirectionCone cone_if_flat(const Shape& shape) {
  const Vec3f axis = shape.sample_area(probe(0)).point.ng;
  for (int i = 1; i < probes; ++i)
    if (!(dot(shape.sample_area(probe(i)).point.ng, axis) > 1.0f - 1e-5f)) return {};
  return {axis, 1.0f - 1e-5f};
}

}  // namespace

DirectionCone cone_of_normals(const Shape& shape) {
  const TriangleMesh* mesh = shape.mesh();
  return mesh ? cone_of_triangles(shape, *mesh) : cone_if_flat(shape);
}

}  // namespace kaustik
