#pragma once
// Geometry at a point of a triangle; inline and in vector registers because every bounce of every
// path passes here.

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// x, y, z in a vector register; the last lane is zero.
using Lanes = float __attribute__((vector_size(16)));
using LaneMask = int32_t __attribute__((vector_size(16)));

inline Lanes lanes(const Vec3f& v) { return Lanes{v.x, v.y, v.z, 0}; }
inline Vec3f vec3(Lanes v) { return {v[0], v[1], v[2]}; }
inline float sum_of(Lanes v) { return v[0] + v[1] + v[2]; }
inline Lanes lane_abs(Lanes v) { return Lanes(LaneMask(v) & 0x7fffffff); }
inline Lanes lane_max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes yzx(Lanes v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }
inline Lanes zxy(Lanes v) { return __builtin_shufflevector(v, v, 2, 0, 1, 3); }

/// The normal of a triangle with the sensitivity of its rounding.
struct TriangleNormal {
  Lanes unit;   ///< zero if the triangle is degenerate
  Lanes slack;  ///< bound on the error of unit's components, in units of float_rounding
};

/// `n` scaled to length one, and the factor that did it; zero for what has no direction.
inline Lanes unit_and_scale(Lanes n, float& scale) {
  const float length_sq = sum_of(n * n);
  if (length_sq > 1e-30f && length_sq < 1e30f) [[likely]] {
    scale = 1.0f / std::sqrt(length_sq);
    return n * scale;
  }
  // The square leaves the range of floats: scaled by the largest component first.
  const float largest = max_abs(vec3(n));
  scale = 0;
  if (!(largest > std::numeric_limits<float>::min())) return Lanes{0, 0, 0, 0};
  const Lanes scaled = n * (1.0f / largest);
  const float inv_length = 1.0f / std::sqrt(sum_of(scaled * scaled));
  scale = inv_length / largest;
  return scaled * inv_length;
}

/// The normal before its length is one, and products that were subtracted in it.
struct TriangleCross {
  Lanes normal, products;
};

/// cross(p1 - p0, p2 - p0), each component from the two edges whose products cancel least, as
/// Embree does; slivers have normals too.
inline TriangleCross triangle_cross(Lanes p0, Lanes p1, Lanes p2) {
  const Lanes a = p2 - p0, b = p0 - p1, c = p1 - p2;
  const Lanes ab = zxy(a) * yzx(b), bc = zxy(b) * yzx(c);
  const LaneMask use_ab = lane_abs(ab) < lane_abs(bc);
  return {use_ab ? yzx(a) * zxy(b) - ab : yzx(b) * zxy(c) - bc, use_ab ? ab : bc};
}

inline TriangleNormal triangle_normal(Lanes p0, Lanes p1, Lanes p2) {
  const TriangleCross cross = triangle_cross(p0, p1, p2);
  float scale = 0;
  const Lanes unit = unit_and_scale(cross.normal, scale);
  return {unit, lane_abs(cross.products) * (8.0f * scale) + lane_abs(unit) * 4.0f};
}

inline Vec3f triangle_normal(const Vec3f& p0, const Vec3f& p1, const Vec3f& p2) {
  return vec3(triangle_normal(lanes(p0), lanes(p1), lanes(p2)).unit);
}

/// Bound on the distance along the normal between an interpolated point and the plane of the
/// triangle as Embree's robust test computes it: interpolation 5, vertices relative to the origin
/// 2, three-term dot products 6 roundings of the coordinates, and the tilt of its normal.
inline float triangle_error(Lanes p0, Lanes p1, Lanes p2, Lanes position,
                            const TriangleNormal& normal) {
  const Lanes largest = lane_max(lane_max(lane_abs(p0), lane_abs(p1)), lane_abs(p2));
  return float_rounding *
         sum_of(lane_abs(normal.unit) * largest * 16.0f + lane_abs(position - p0) * normal.slack);
}

/// Unit shading normal on the side of `ng`; `ng` itself where the interpolated one vanishes.
inline Lanes shading_normal(Lanes n, Lanes ng) {
  const float n_sq = sum_of(n * n);
  if (!(n_sq > 1e-12f)) return ng;
  return n * std::copysign(1.0f / std::sqrt(n_sq), sum_of(n * ng));
}

/// Geometry of `mesh` at barycentric coordinates b1, b2 (of the second and third corner) of a
/// triangle.
inline SurfacePoint triangle_surface_point(const TriangleMesh& mesh, uint32_t triangle, float b1,
                                           float b2) {
  const auto [i0, i1, i2] = mesh.triangles[triangle];
  const Lanes p0 = lanes(mesh.positions[i0]), p1 = lanes(mesh.positions[i1]),
              p2 = lanes(mesh.positions[i2]);
  const float b0 = 1.0f - b1 - b2;
  const TriangleNormal normal = triangle_normal(p0, p1, p2);
  const Lanes position = p0 * b0 + p1 * b1 + p2 * b2;

  SurfacePoint point;
  point.primitive = triangle;
  point.position = vec3(position);
  point.ng = vec3(normal.unit);
  point.error = triangle_error(p0, p1, p2, position, normal);
  point.ns = point.ng;
  if (!mesh.normals.empty()) {
    const Lanes n =
        lanes(mesh.normals[i0]) * b0 + lanes(mesh.normals[i1]) * b1 + lanes(mesh.normals[i2]) * b2;
    point.ns = vec3(shading_normal(n, normal.unit));
  }
  if (mesh.uvs.empty()) {
    point.uv = {b1, b2};
    return point;
  }
  const Vec2f &uv0 = mesh.uvs[i0], &uv1 = mesh.uvs[i1], &uv2 = mesh.uvs[i2];
  point.uv = uv0 * b0 + uv1 * b1 + uv2 * b2;
  return point;
}

/// By the texture coordinates, the same everywhere in a triangle.
inline UvDerivatives triangle_uv_derivatives(const TriangleMesh& mesh, uint32_t triangle) {
  const auto [i0, i1, i2] = mesh.triangles[triangle];
  const Vec3f e1 = mesh.positions[i1] - mesh.positions[i0];
  const Vec3f e2 = mesh.positions[i2] - mesh.positions[i0];
  if (mesh.uvs.empty()) return {e1, e2};
  const Vec2f d1 = mesh.uvs[i1] - mesh.uvs[i0], d2 = mesh.uvs[i2] - mesh.uvs[i0];
  const float inverse = 1.0f / (d1.x * d2.y - d1.y * d2.x);
  const UvDerivatives d{(e1 * d2.y - e2 * d1.y) * inverse, (e2 * d1.x - e1 * d2.x) * inverse};
  // Texture coordinates all on a line have none.
  return is_finite(d.dpdu) && is_finite(d.dpdv) ? d : UvDerivatives();
}

}  // namespace kaustik
