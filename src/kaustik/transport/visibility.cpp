#include "kaustik/transport/visibility.h"

#include "kaustik/transport/null_boundaries.h"

namespace kaustik {
namespace {

bool lets_pass(const Scene& scene, const Surface& surface, ShadowRayTo to) {
  return surface.traits.is_null || (to == ShadowRayTo::camera && scene.is_hidden(surface.light));
}

/// Follows a shadow ray through null boundaries, `pass(medium, ray, parameter)` being told of every
/// segment in a medium, to that parameter of the ray: false ends it. False if anything else blocks
/// it.
template <typename Pass>
bool follow_shadow_ray(const Scene& scene, Ray ray, const Medium* medium, uint64_t& rays,
                       ShadowRayTo to, const Pass& pass) {
  // Nearer to its end than it is known itself a ray is there. Else one that ends where boundaries
  // meet would come nearer forever, where coordinates of zero round to less and less.
  float near = 0;
  if (std::isfinite(ray.t_max)) {
    const Vec3f end = ray.origin + ray.direction * ray.t_max;
    near = 8 * float_rounding * (length(ray.origin) + length(end));
  }
  for (int boundary = 0; boundary < most_null_boundaries; ++boundary) {
    Hit hit;
    ++rays;
    const bool found = scene.intersect(ray, hit);
    if (found && !scene.may_be_null(hit.shape) && !lets_pass(scene, scene.surface(hit.shape), to))
      return false;
    // The direction of a shadow ray counts in its own length.
    const float parameter = found ? hit.t : ray.t_max;
    if (medium && !pass(*medium, ray, parameter)) return false;
    if (!found) return true;
    const SurfacePoint point = scene.tracer().surface_point(ray, hit);
    const Surface& surface = scene.surface(point.shape);
    if (!lets_pass(scene, surface, to)) return false;
    medium = surface.medium_toward(dot(ray.direction, point.ng) > 0, medium);
    const Vec3f origin = offset_origin(point, ray.direction);
    if (std::isfinite(ray.t_max)) {
      const Vec3f to_end = ray.origin + ray.direction * ray.t_max - origin;
      // The end may lie just behind the boundary, within its offset.
      if (!(dot(to_end, ray.direction) > 0) || length(to_end) <= near) return true;
      ray = {origin, to_end, 1.0f};
    } else {
      ray.origin = origin;
    }
  }
  return false;
}

}  // namespace

Spectrum transmittance_through_media(const Scene& scene, Ray ray, const Medium* medium,
                                     const LightOnItsWay& of, uint64_t& rays, ShadowRayTo to) {
  Spectrum left(1);
  const bool arrives = follow_shadow_ray(
      scene, ray, medium, rays, to, [&](const Medium& in, const Ray& along, float parameter) {
        const float unit = length(along.direction);
        const MediumSegment segment{along.origin, along.direction * (1 / unit), parameter * unit};
        left *= of.may_be_rough ? in.rough_transmittance(segment, of.wavelengths, of.sampler)
                                : in.transmittance(segment, of.wavelengths, of.sampler);
        return !left.is_zero();
      });
  return arrives ? left : Spectrum();
}

bool is_unobstructed(const Scene& scene, const Ray& ray, uint64_t& rays, ShadowRayTo to) {
  if (scene.has_media() || (to == ShadowRayTo::camera && scene.hides_lights()))
    return follow_shadow_ray(scene, ray, nullptr, rays, to,
                             [](const Medium&, const Ray&, float) { return true; });
  ++rays;
  return !scene.occluded(ray);
}

}  // namespace kaustik
