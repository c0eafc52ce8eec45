#include "kaustik/photon/coverage/surface_sight.h"

#include <algorithm>

#include "kaustik/photon/coverage/look_through.h"

namespace kaustik {
namespace {

/// Of the distance: how high the straight way lies over the surface, and that over its bend.
constexpr float straight_height = 1e-3f, bend_height = 0.25f;
/// By so much normals part over the way where a surface bends away, radians.
constexpr float bent = 0.02f;

float largest_coordinate(const Vec3f& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

}  // namespace

bool SurfaceSight::is_free(const Ray& ray) const {
  ++rays_;
  if (!scene_.occluded(ray)) return true;
  const auto stops = [&](const SurfacePoint&, const Hit& hit) {
    return hides(scene_, hit.shape, shape_);
  };
  // To the end itself, however the offset has moved the origin.
  const auto pass = [](const SurfacePoint& point, const Hit&, Ray& rest) {
    const Vec3f end = rest.origin + rest.direction * rest.t_max;
    const Vec3f origin = offset_origin(point, rest.direction);
    rest = {origin, end - origin, 1};
    return dot(rest.direction, point.ng) * dot(end - point.position, point.ng) > 0;
  };
  return look_through(scene_, ray, rays_, stops, pass) == Look::free;
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
