#pragma once
#include "kaustik/scene/look_through.h"

namespace kaustik {

/// Whether a shape hides what lies behind it. What light passes through does not, but for the shape
/// `own` on which both ends of the look lie.
inline bool hides(const Scene& scene, uint32_t shape, uint32_t own) {
  return shape == own || !scene.surface(shape).traits.transmits;
}

/// look_through() as far as most looks go: `stops(point, hit)` and `pass(point, hit, ray)` as
/// there. Counts rays.
template <typename Stops, typename Pass>
Look look_through(const Scene& scene, const Ray& ray, uint64_t& rays, const Stops& stops,
                  const Pass& pass) {
  constexpr int most_layers = 16;
  return look_through(
      scene, ray, most_layers,
      [&](const Ray& next, Hit& hit) {
        ++rays;
        return scene.intersect(next, hit);
      },
      [&](const SurfacePoint& point, const Hit& hit, const Ray&) { return stops(point, hit); },
      pass);
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
