#pragma once
// Geometry at a point of a triangle; inline because every bounce of every path passes here.

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// The normal of a triangle with the sensitivity of its rounding.
struct TriangleNormal {
  Vec3f unit;   ///< zero if the triangle is degenerate
  Vec3f slack;  ///< bound on the error of unit's components over float_rounding
};

/// cross(p1 - p0, p2 - p0), each component from the two edges whose products cancel least, as
/// Embree does; slivers have normals too.
inline TriangleNormal triangle_normal(const Vec3f& p0, const Vec3f& p1, const Vec3f& p2) {
  const Vec3f a = p2 - p0, b = p0 - p1, c = p1 - p2;
  const Vec3f ab(a.z * b.y, a.x * b.z, a.y * b.x);
  const Vec3f bc(b.z * c.y, b.x * c.z, b.y * c.x);
  const bool use_ab[3] = {std::fabs(ab.x) < std::fabs(bc.x), std::fabs(ab.y) < std::fabs(bc.y),
                          std::fabs(ab.z) < std::fabs(bc.z)};
  Vec3f n(use_ab[0] ? a.y * b.z - ab.x : b.y * c.z - bc.x,
          use_ab[1] ? a.z * b.x - ab.y : b.z * c.x - bc.y,
          use_ab[2] ? a.x * b.y - ab.z : b.x * c.y - bc.z);
  const float largest = max_abs(n);
  if (!(largest > std::numeric_limits<float>::min())) return {Vec3f(0, 0, 0), Vec3f(0, 0, 0)};
  const Vec3f products(std::fabs(use_ab[0] ? ab.x : bc.x), std::fabs(use_ab[1] ? ab.y : bc.y),
                       std::fabs(use_ab[2] ? ab.z : bc.z));
  // Scaled by the largest component first: its square may leave the range of floats.
  const float inv_largest = 1.0f / largest;
  n *= inv_largest;
  const float inv_length = 1.0f / length(n);
  n *= inv_length;
  const float scale = 4.0f * inv_largest * inv_length;
  return {n, Vec3f(2.0f * products.x * scale + 4.0f * std::fabs(n.x),
                   2.0f * products.y * scale + 4.0f * std::fabs(n.y),
                   2.0f * products.z * scale + 4.0f * std::fabs(n.z))};
}

/// Bound on the distance along the normal between an interpolated point and the plane of the
/// triangle as Embree's robust test computes it: interpolation 5, vertices relative to the origin
/// 2, three-term dot products 6 roundings of the coordinates, and the tilt of its normal.
inline float triangle_error(const Vec3f& p0, const Vec3f& p1, const Vec3f& p2,
                            const Vec3f& position, const TriangleNormal& normal) {
  float sum = 0;
  for (int i = 0; i < 3; ++i) {
    const float largest = std::max({std::fabs(p0[i]), std::fabs(p1[i]), std::fabs(p2[i])});
    sum += 16.0f * std::fabs(normal.unit[i]) * largest +
           std::fabs(position[i] - p0[i]) * normal.slack[i];
  }
  return float_rounding * sum;
}

/// Geometry of `mesh` at barycentric coordinates b1, b2 (of the second and third corner) of a
/// triangle.
inline SurfacePoint triangle_surface_point(const TriangleMesh& mesh, uint32_t triangle, float b1,
                                           float b2) {
  const auto& corner = mesh.triangles[triangle];
  const Vec3f &p0 = mesh.positions[corner[0]], &p1 = mesh.positions[corner[1]],
              &p2 = mesh.positions[corner[2]];
  const float b0 = 1.0f - b1 - b2;
  const TriangleNormal normal = triangle_normal(p0, p1, p2);

  SurfacePoint point;
  point.primitive = triangle;
  point.position = p0 * b0 + p1 * b1 + p2 * b2;
  point.ng = normal.unit;
  point.ns = normal.unit;
  point.error = triangle_error(p0, p1, p2, point.position, normal);
  if (!mesh.normals.empty()) {
    const Vec3f n =
        mesh.normals[corner[0]] * b0 + mesh.normals[corner[1]] * b1 + mesh.normals[corner[2]] * b2;
    const float n_sq = length_sq(n);
    if (n_sq > 1e-12f) {
      const float inv_length = 1.0f / std::sqrt(n_sq);
      point.ns = n * (dot(n, point.ng) < 0 ? -inv_length : inv_length);
    }
  }
  const Vec3f e1 = p1 - p0, e2 = p2 - p0;
  if (mesh.uvs.empty()) {
    point.uv = {b1, b2};
    point.dpdu = e1;
    return point;
  }
  const Vec2f &uv0 = mesh.uvs[corner[0]], &uv1 = mesh.uvs[corner[1]], &uv2 = mesh.uvs[corner[2]];
  point.uv = uv0 * b0 + uv1 * b1 + uv2 * b2;
  const Vec2f d1 = uv1 - uv0, d2 = uv2 - uv0;
  const float determinant = d1.x * d2.y - d1.y * d2.x;
  if (determinant != 0) {
    const Vec3f dpdu = (e1 * d2.y - e2 * d1.y) * (1.0f / determinant);
    point.dpdu = is_finite(dpdu) ? dpdu : Vec3f(0, 0, 0);
  } else {
    point.dpdu = Vec3f(0, 0, 0);
  }
  return point;
}

}  // namespace kaustik
