#pragma once
#include <bit>
#include <cstdint>

#include "kaustik/base/transform.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Direction need not be a unit vector for shadow rays; distances count in its length.
struct Ray {
  Vec3f origin;
  Vec3f direction;
  float t_max = infinity;
};

inline constexpr uint32_t no_instance = 0xffffffffu;
/// Largest relative error of rounding to the nearest float.
inline constexpr float float_rounding = 0x1p-24f;

/// The closest hit as ray tracing leaves it; RayTracer::surface_point turns it into geometry.
struct Hit {
  float t = infinity;
  float u = 0, v = 0;      ///< of the primitive; barycentric for triangles
  Vec3f ng{0, 0, 0};       ///< unnormalised geometric normal, in the space of the shape
  uint32_t shape = 0;      ///< index into the scene's shapes (within its group if instanced)
  uint32_t primitive = 0;  ///< triangle index; 0 for shapes of one piece
  uint32_t instance = no_instance;
};

/// A point on a surface, in world space.
struct SurfacePoint {
  Vec3f position{0, 0, 0};
  Vec3f ng{0, 0, 0};  ///< geometric normal, unit, outward by the shape's convention
  Vec3f ns{0, 0, 0};  ///< shading normal, unit, in the same half space as ng
  Vec2f uv{0, 0};
  float error = 0;     ///< bound on the distance, along ng, between `position` and the surface as
                       ///< the ray intersection sees it
  uint32_t shape = 0;  ///< index into the scene's shapes and parts of bodies
  uint32_t primitive = 0;
  uint32_t instance = no_instance;
};

/// How the position on a surface changes with the texture coordinates, m per unit; both zero where
/// that is unknown.
struct UvDerivatives {
  Vec3f dpdu{0, 0, 0}, dpdv{0, 0, 0};
};

// Inline: a ray that a function returns is copied, and a copy of what was just written waits for it
// to reach the cache.

/// `from` + `offset` and one float further in that direction; what std::nextafter does for finite
/// numbers, inline.
inline float round_outward(float from, float offset) {
  const float moved = from + offset;
  if (offset == 0) return moved;
  if (moved == 0) return std::copysign(std::numeric_limits<float>::denorm_min(), offset);
  const bool away_from_zero = (moved > 0) == (offset > 0);
  return std::bit_cast<float>(std::bit_cast<uint32_t>(moved) + (away_from_zero ? 1u : ~0u));
}

/// `position` moved off its surface by at least `distance`, to the side of `direction`.
inline Vec3f offset_by(const SurfacePoint& point, const Vec3f& direction, float distance) {
  const Vec3f offset = point.ng * (dot(direction, point.ng) < 0 ? -distance : distance);
  return {round_outward(point.position.x, offset.x), round_outward(point.position.y, offset.y),
          round_outward(point.position.z, offset.z)};
}

/// `position` moved off its surface to the side of `direction`, just far enough that a ray from
/// there cannot meet the surface again by rounding: by the point's own error bound, which follows
/// from the magnitude of the coordinates and never from the scene's scale.
inline Vec3f offset_origin(const SurfacePoint& point, const Vec3f& direction) {
  return offset_by(point, direction, point.error);
}

/// A ray that leaves `point` along unit `direction`.
inline Ray spawn_ray(const SurfacePoint& point, const Vec3f& direction) {
  return {offset_origin(point, direction), direction, infinity};
}

/// A ray from `from` that ends just before `to`; its direction is not normalised, t_max is 1.
inline Ray spawn_ray_to(const SurfacePoint& from, const Vec3f& to) {
  const Vec3f origin = offset_origin(from, to - from.position);
  return {origin, to - origin, 1.0f};
}
inline Ray spawn_ray_to(const SurfacePoint& from, const SurfacePoint& to) {
  const Vec3f separation = to.position - from.position;
  const Vec3f origin = offset_origin(from, separation);
  // The far end also has to clear what the length of the ray adds: the rounding of its direction
  // and the intersection test's own sums over coordinates relative to the ray's origin.
  const float length_error =
      8 * float_rounding *
      (std::fabs(to.ng.x * separation.x) + std::fabs(to.ng.y * separation.y) +
       std::fabs(to.ng.z * separation.z));
  const Vec3f target = offset_by(to, -separation, to.error + length_error);
  return {origin, target - origin, 1.0f};
}

}  // namespace kaustik
