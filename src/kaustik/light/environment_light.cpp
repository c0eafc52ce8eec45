#include "kaustik/light/environment_light.h"

namespace kaustik {

LightBounds EnvironmentLight::bounds() const {
  LightBounds b;
  b.infinite = true;
  return b;
}

LightSample EnvironmentLight::sample_toward(const LightQuery& query, const Vec2f& u) const {
  LightSample result;
  result.direction = sample_direction(u, {&query});
  if (!(length_sq(result.direction) > 0)) return result;
  result.radiance = background(result.direction);
  result.pdf_solid_angle = direction_pdf(result.direction, {&query});
  return result;
}

float EnvironmentLight::pdf_toward_direction(const LightQuery& query,
                                             const Vec3f& direction) const {
  return direction_pdf(direction, {&query});
}

EmissionSample EnvironmentLight::sample_emission(const Vec2f& u_position,
                                                 const Vec2f& u_direction) const {
  EmissionSample result;
  result.point = free_point({0, 0, 0});
  result.direction = sample_travel_direction(u_direction, result.pdf_direction);
  if (!(result.pdf_direction > 0)) return result;
  result.point = free_point(disk_.origin(result.direction, u_position));
  result.pdf_position = 1.0f / disk_.area();
  result.flux = background(-result.direction) * (disk_.area() / result.pdf_direction);
  return result;
}

float EnvironmentLight::emission_pdf_position(const SurfacePoint&) const {
  return 1.0f / disk_.area();
}

float EnvironmentLight::emission_pdf_direction(const SurfacePoint&, const Vec3f& direction) const {
  return direction_pdf(-direction, {});
}

Spectrum EnvironmentLight::emitted_from(const SurfacePoint&, const Vec3f& direction) const {
  return background(-direction);
}

Vec3f EnvironmentLight::sample_travel_direction(const Vec2f& u, float& pdf) const {
  const Vec3f direction = sample_direction(u, {});
  pdf = length_sq(direction) > 0 ? direction_pdf(direction, {}) : 0.0f;
  return pdf > 0 ? -direction : Vec3f(0, 0, 1);
}

}  // namespace kaustik
