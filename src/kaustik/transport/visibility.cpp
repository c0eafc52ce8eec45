#include "kaustik/transport/visibility.h"

#include "kaustik/transport/null_boundaries.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {
namespace {

bool is_looked_through(const Scene& scene, const Surface& surface, ShadowRayTo to) {
  return surface.traits.is_null || (to == ShadowRayTo::camera && scene.is_hidden(surface.light));
}

/// Of light of these wavelengths along a shadow ray, whose direction counts in its own length.
Spectrum straight_share(const Scene& scene, const Ray& ray, const Hit& hit,
                        const Wavelengths& wavelengths) {
  const float unit = length(ray.direction);
  Ray along = ray;
  along.direction = ray.direction * (1 / unit);
  Hit met = hit;
  met.t *= unit;
  SurfaceVertex vertex;
  // Flux and radiance pass alike.
  vertex.meet(scene, along, met, TransportMode::radiance, {}, wavelengths);
  return vertex.straight();
}

/// Follows a shadow ray. `pass(medium, ray, parameter)` is told of every segment in a medium, to
/// that parameter of the ray, `meet(ray, hit)` of every surface that passes a part straight: false
/// from them ends it. False if anything else blocks it.
template <typename Pass, typename Meet>
bool follow_shadow_ray(const Scene& scene, Ray ray, const Medium* medium, uint64_t& rays,
                       ShadowRayTo to, const Pass& pass, const Meet& meet) {
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
    if (found && !scene.may_let_pass(hit.shape) &&
        !is_looked_through(scene, scene.surface(hit.shape), to))
      return false;
    // The direction of a shadow ray counts in its own length.
    const float parameter = found ? hit.t : ray.t_max;
    if (medium && !pass(*medium, ray, parameter)) return false;
    if (!found) return true;
    const SurfacePoint point = scene.tracer().surface_point(ray, hit);
    const Surface& surface = scene.surface(point.shape);
    if (!is_looked_through(scene, surface, to) &&
        !(surface.traits.passes_straight && meet(ray, hit)))
      return false;
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

Spectrum transmittance_on_way(const Scene& scene, const Ray& ray, const Medium* medium,
                              const LightOnItsWay& of, uint64_t& rays, ShadowRayTo to) {
  Spectrum left(1);
  const bool arrives = follow_shadow_ray(
      scene, ray, medium, rays, to,
      [&](const Medium& in, const Ray& along, float parameter) {
        const float unit = length(along.direction);
        const MediumSegment segment{along.origin, along.direction * (1 / unit), parameter * unit};
        left *= of.may_be_rough ? in.rough_transmittance(segment, of.wavelengths, of.sampler)
                                : in.transmittance(segment, of.wavelengths, of.sampler);
        return !left.is_zero();
      },
      [&](const Ray& along, const Hit& hit) {
        left *= straight_share(scene, along, hit, of.wavelengths);
        return !left.is_zero();
      });
  return arrives ? left : Spectrum();
}

bool is_unobstructed(const Scene& scene, const Ray& ray, uint64_t& rays, ShadowRayTo to) {
  if (lets_shadow_rays_pass(scene, to))
    return follow_shadow_ray(
        scene, ray, nullptr, rays, to, [](const Medium&, const Ray&, float) { return true; },
        [&](const Ray& along, const Hit& hit) {
          return !straight_share(scene, along, hit, {}).is_zero();
        });
  ++rays;
  return !scene.occluded(ray);
}

}  // namespace kaustik
