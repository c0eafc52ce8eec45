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
Vec3d area_vector(const TriangleMesh& mesh, size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3d origin(mesh.positions[a]);
  return (Vec3d(mesh.positions[b]) - origin).cross(Vec3d(mesh.positions[c]) - origin);
}

/// +1 where normals follow the order of the corners, −1 where they oppose it, 0 where neither holds
/// for all the probes.
int winding_sign(const Shape& shape, const TriangleMesh& mesh) {
  int agree = 0, oppose = 0;
  for (int i = 0; i < probes; ++i) {
    const ShapeSample s = shape.sample_area(probe(i));
    if (!(s.pdf_area > 0)) continue;
    if (s.point.primitive >= mesh.triangles.size()) return 0;
    (area_vector(mesh, s.point.primitive).dot(Vec3d(s.point.ng)) > 0 ? agree : oppose)++;
  }
  return oppose == 0 ? 1 : agree == 0 ? -1 : 0;
}

DirectionCone cone_of_triangles(const Shape& shape, const TriangleMesh& mesh) {
  const int sign = winding_sign(shape, mesh);
  if (sign == 0) return {};
  Vec3d sum(0, 0, 0);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) sum += area_vector(mesh, i);
  if (!(sum.length() > 0)) return {};
  const Vec3d axis = sum.normalized() * double(sign);
  double cos_angle = 1;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3d v = area_vector(mesh, i) * double(sign);
    const double v_length = v.length();
    if (v_length > 0) cos_angle = std::min(cos_angle, axis.dot(v) / v_length);
  }
  const double slack = 1e-6;
  return cos_angle > slack - 1 ? DirectionCone{Vec3f(axis), float(cos_angle - slack)}
                               : DirectionCone{};
}

/// Analytic shapes that can be sampled are quadrics: one whose normals are equal at many points is
/// flat.
DirectionCone cone_if_flat(const Shape& shape) {
  if (!(shape.area() > 0)) return {};
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
