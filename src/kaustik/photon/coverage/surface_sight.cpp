#include "kaustik/photon/coverage/surface_sight.h"

#include <algorithm>

namespace kaustik {
namespace {

/// Of the distance: how high the straight way lies over the surface, and that over its bend.
constexpr float straight_height = 1e-3f, bend_height = 0.25f;
/// By so much normals part over the way where a surface bends away, radians.
constexpr float bent = 0.02f;
/// What is between is looked through so many times; then it hides what lies behind.
constexpr int most_layers_seen = 16;

float largest_coordinate(const Vec3f& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

}  // namespace

bool SurfaceSight::hides(const Hit& hit) const {
  return hit.shape == shape_ || !scene_.surface(hit.shape).traits.transmits;
}

bool SurfaceSight::is_free(Ray ray) const {
  ++rays_;
  if (!scene_.occluded(ray)) return true;
  for (int layer = 0; layer < most_layers_seen; ++layer) {
    Hit hit;
    ++rays_;
    if (!scene_.intersect(ray, hit)) return true;
    if (hides(hit)) return false;
    const SurfacePoint point = scene_.tracer().surface_point(ray, hit);
    const Vec3f end = ray.origin + ray.direction * ray.t_max;
    ray.origin = offset_origin(point, ray.direction);
    ray.direction = end - ray.origin;
    ray.t_max = 1;
    if (!(dot(ray.direction, point.ng) * dot(end - point.position, point.ng) > 0)) return true;
  }
  return false;
}

bool SurfaceSight::sees(const Vec3f& normal, const Vec3f& other, const Vec3f& other_normal) const {
  if (dot(normal, clear_.normal) > 0 && clear_.holds(other - position_)) return true;
  const float distance = length(other - position_);
  // Positions are rounded, by hits and by transforms.
  const float rounding =
      64 * float_rounding * std::max(largest_coordinate(position_), largest_coordinate(other));
  const float height = straight_height * distance + rounding;
  const Vec3f from = position_ + normal * height, to = other + other_normal * height;
  const auto straight = [&] { return is_free({from, to - from, 1}); };
  const auto over_bend = [&] {
    const Vec3f over =
        (position_ + other) * 0.5f + (normal + other_normal) * (0.5f * bend_height * distance);
    return is_free({from, over - from, 1}) && is_free({over, to - over, 1});
  };
  // The more promising first.
  const bool bends_away = dot(other_normal - normal, other - position_) > bent * distance;
  return bends_away ? over_bend() || straight() : straight() || over_bend();
}

}  // namespace kaustik
