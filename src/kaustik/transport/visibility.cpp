#include "kaustik/transport/visibility.h"

namespace kaustik {

Spectrum transmittance_through_media(const Scene& scene, Ray ray, const Medium* medium,
                                     uint64_t& rays) {
  Spectrum left(1);
  for (;;) {
    Hit hit;
    ++rays;
    const bool found = scene.intersect(ray, hit);
    if (found && !scene.surface(hit.shape).is_null) return {};
    // The direction of a shadow ray counts in its own length.
    const float parameter = found ? hit.t : ray.t_max;
    if (medium) left *= medium->transmittance(parameter * length(ray.direction));
    if (!found || left.is_zero()) return left;
    const SurfacePoint point = scene.tracer().surface_point(ray, hit);
    const Surface& surface = scene.surface(point.shape);
    medium = surface.medium_toward(dot(ray.direction, point.ng) > 0, medium);
    const Vec3f origin = offset_origin(point, ray.direction);
    if (std::isfinite(ray.t_max)) {
      const Vec3f to_end = ray.origin + ray.direction * ray.t_max - origin;
      // The end may lie just behind the boundary, within its offset.
      if (!(dot(to_end, ray.direction) > 0)) return left;
      ray = {origin, to_end, 1.0f};
    } else {
      ray.origin = origin;
    }
  }
}

}  // namespace kaustik
