#include "kaustik/light/light.h"

#include "kaustik/light/light_kinds.h"

namespace kaustik {

float Light::classical_attenuation(const Vec3f&) const { return 1; }
float Light::pdf_toward(const LightQuery&, const SurfacePoint&) const { return 0; }
float Light::pdf_toward_direction(const LightQuery&, const Vec3f&) const { return 0; }
Spectrum Light::emitted(const SurfacePoint&, const Vec3f&) const { return {}; }
Spectrum Light::background(const Vec3f&) const { return {}; }
EmissionSample Light::sample_origin(const Vec2f&) const { return {}; }
Spectrum Light::emitted_from(const SurfacePoint&, const Vec3f&) const { return {}; }
Vec3f Light::sample_travel_direction(const Vec2f&, float& pdf) const {
  pdf = 0;
  return {0, 0, 1};
}

const std::vector<LightType>& light_types() {
  static const std::vector<LightType> types = {
      area_light_type(),        point_light_type(),       spot_light_type(),
      directional_light_type(), constant_light_type(),    envmap_light_type(),
      sunsky_light_type(),      sky_light_type(),         sun_light_type(),
      background_light_type(),  distributed_light_type(), distributed_spot_light_type()};
  return types;
}

}  // namespace kaustik
