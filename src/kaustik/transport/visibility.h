#pragma once
#include "kaustik/scene/scene.h"

namespace kaustik {

/// What media ask of the light that passes through them.
struct LightOnItsWay {
  Wavelengths wavelengths;
  const Sampler& sampler;  ///< as of Medium::transmittance()
  /// It comes from a point in a medium, or goes to one: Medium::rough_transmittance() will do.
  bool may_be_rough = false;
};

/// Where a shadow ray leads: to the camera it passes hidden lamps, too (Scene::is_hidden).
enum class ShadowRayTo { light, camera };

/// Whether anything in the scene may do so.
inline bool lets_shadow_rays_pass(const Scene& scene, ShadowRayTo to) {
  return scene.has_media() || scene.passes_straight() ||
         (to == ShadowRayTo::camera && scene.hides_lights());
}

/// Light left of what sets out through `medium` along the shadow ray `ray`, where something lets
/// shadow rays pass: null boundaries do, and surfaces by their straight share; media take theirs;
/// everything else blocks it (glass too: what it refracts goes elsewhere). Counts rays.
Spectrum transmittance_on_way(const Scene& scene, const Ray& ray, const Medium* medium,
                              const LightOnItsWay& of, uint64_t& rays,
                              ShadowRayTo to = ShadowRayTo::light);

/// The same for any scene: 1 or 0 where there is no medium.
inline Spectrum shadow_ray_transmittance(const Scene& scene, const Ray& ray, const Medium* medium,
                                         const LightOnItsWay& of, uint64_t& rays,
                                         ShadowRayTo to = ShadowRayTo::light) {
  if (lets_shadow_rays_pass(scene, to))
    return transmittance_on_way(scene, ray, medium, of, rays, to);
  ++rays;
  return scene.occluded(ray) ? Spectrum() : Spectrum(1);
}

/// Whether a shadow ray arrives, or a part of it; media hide nothing. Counts rays.
bool is_unobstructed(const Scene& scene, const Ray& ray, uint64_t& rays,
                     ShadowRayTo to = ShadowRayTo::light);

}  // namespace kaustik
