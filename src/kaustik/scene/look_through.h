#pragma once
#include "kaustik/scene/scene.h"

namespace kaustik {

/// How a look along a ray through several surfaces came to its end.
enum class Look {
  free,     ///< nothing more is on the way
  stopped,  ///< where it was asked to
  too_deep  ///< after so many surfaces that it is not followed on
};

/// Follows a ray from surface to surface, `most_layers` at most. `meets(ray, hit)` finds the next
/// one on it; `stops(point, hit, ray)` is asked there, and where it answers false
/// `pass(point, hit, ray)` has the ray begin behind it; false from that: there is no more to see.
template <typename Meets, typename Stops, typename Pass>
Look look_through(const Scene& scene, Ray ray, int most_layers, const Meets& meets,
                  const Stops& stops, const Pass& pass) {
  for (int surface = 0; surface < most_layers; ++surface) {
    Hit hit;
    if (!meets(ray, hit)) return Look::free;
    const SurfacePoint point = scene.tracer().surface_point(ray, hit);
    if (stops(point, hit, ray)) return Look::stopped;
    if (!pass(point, hit, ray)) return Look::free;
  }
  return Look::too_deep;
}

/// For look_through(): straight on, to no end.
inline constexpr auto straight_on = [](const SurfacePoint& point, const Hit&, Ray& ray) {
  ray = spawn_ray(point, ray.direction);
  return true;
};

/// The same straight on, for what is to be known of the scene before it is rendered: observers of
/// rays are not told.
template <typename Stops>
Look probe_through(const Scene& scene, const Ray& ray, int most_layers, const Stops& stops) {
  return look_through(
      scene, ray, most_layers,
      [&](const Ray& next, Hit& hit) { return scene.tracer().intersect(next, hit); }, stops,
      straight_on);
}

}  // namespace kaustik
