#pragma once
#include "kaustik/scene/scene.h"

namespace kaustik {

/// How a look through glass and the like came to its end.
enum class Look {
  free,     ///< nothing more is on the way
  stopped,  ///< where it was asked to
  too_deep  ///< after so many layers that it is not followed on
};

/// Whether a shape hides what lies behind it. What light passes through does not, but for the shape
/// `own` on which both ends of the look lie.
inline bool hides(const Scene& scene, uint32_t shape, uint32_t own) {
  return shape == own || !scene.surface(shape).traits.transmits;
}

/// Looks along a ray through what does not stop it: `stops(point, hit)` is asked about every point
/// that it meets, and where it answers false `pass(point, hit, ray)` has the ray begin behind it;
/// false from that: there is no more to see. Counts rays.
template <typename Stops, typename Pass>
Look look_through(const Scene& scene, Ray ray, uint64_t& rays, const Stops& stops,
                  const Pass& pass) {
  constexpr int most_layers = 16;
  for (int layer = 0; layer < most_layers; ++layer) {
    Hit hit;
    ++rays;
    if (!scene.intersect(ray, hit)) return Look::free;
    const SurfacePoint point = scene.tracer().surface_point(ray, hit);
    if (stops(point, hit)) return Look::stopped;
    if (!pass(point, hit, ray)) return Look::free;
  }
  return Look::too_deep;
}

/// The same along a ray of unit direction.
template <typename Stops>
Look look_through(const Scene& scene, const Ray& ray, uint64_t& rays, const Stops& stops) {
  if (!(ray.t_max > 0)) return Look::free;
  return look_through(scene, ray, rays, stops,
                      [](const SurfacePoint& point, const Hit& hit, Ray& rest) {
                        rest.t_max -= hit.t;
                        rest.origin = spawn_ray(point, rest.direction).origin;
                        return rest.t_max > 0;
                      });
}

}  // namespace kaustik
