#include "kaustik/geometry/ray.h"

#include <bit>

namespace kaustik {
namespace {

/// `from` + `offset` and one float further in that direction; what std::nextafter does for finite
/// numbers, inline.
float round_outward(float from, float offset) {
  const float moved = from + offset;
  if (offset == 0) return moved;
  if (moved == 0) return std::copysign(std::numeric_limits<float>::denorm_min(), offset);
  const bool away_from_zero = (moved > 0) == (offset > 0);
  return std::bit_cast<float>(std::bit_cast<uint32_t>(moved) + (away_from_zero ? 1u : ~0u));
}

Vec3f offset_by(const SurfacePoint& point, const Vec3f& direction, float distance) {
  const Vec3f offset = point.ng * (dot(direction, point.ng) < 0 ? -distance : distance);
  return {round_outward(point.position.x, offset.x), round_outward(point.position.y, offset.y),
          round_outward(point.position.z, offset.z)};
}

}  // namespace

Vec3f offset_origin(const SurfacePoint& point, const Vec3f& direction) {
  return offset_by(point, direction, point.error);
}

Ray spawn_ray(const SurfacePoint& point, const Vec3f& direction) {
  return {offset_origin(point, direction), direction, infinity};
}

Ray spawn_ray_to(const SurfacePoint& from, const Vec3f& to) {
  const Vec3f origin = offset_origin(from, to - from.position);
  return {origin, to - origin, 1.0f};
}

Ray spawn_ray_to(const SurfacePoint& from, const SurfacePoint& to) {
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
