#include "kaustik/light/environment_light.h"

namespace kaustik {

LightSample EnvironmentLight::sample_toward(const LightQuery& query, const Vec2f& u) const {
  LightSample result;
  result.direction = sample_direction(u, {&query});
  if (!(length_sq(result.direction) > 0)) return result;
  result.radiance = background(result.direction, query.wavelengths);
  result.pdf_solid_angle = direction_pdf(result.direction, {&query});
  return result;
}

float EnvironmentLight::pdf_toward(const LightQuery& query, const LightTarget& target) const {
  return direction_pdf(target.direction, {&query});
}

EmissionSample EnvironmentLight::sample_emission(const Vec2f& u_position, const Vec2f& u_direction,
                                                 const Wavelengths& wavelengths) const {
  EmissionSample result;
  result.point = free_point({0, 0, 0});
  const TravelDirection travel = sample_travel_direction(u_direction);
  result.direction = travel.direction;
  result.pdf_direction = travel.pdf;
  if (!(travel.pdf > 0)) return result;
  result.point = free_point(disk_.origin(result.direction, u_position));
  result.pdf_position = 1.0f / disk_.area();
  result.flux = background(-result.direction, wavelengths) * (disk_.area() / result.pdf_direction);
  return result;
}

float EnvironmentLight::emission_pdf_position(const SurfacePoint&) const {
  return 1.0f / disk_.area();
}

float EnvironmentLight::emission_pdf_direction(const SurfacePoint&, const Vec3f& direction) const {
  return direction_pdf(-direction, {});
}

Spectrum EnvironmentLight::emitted(const SurfacePoint&, const Vec3f& direction,
                                   const Wavelengths& wavelengths) const {
  return background(-direction, wavelengths);
}

TravelDirection EnvironmentLight::sample_travel_direction(const Vec2f& u) const {
  const Vec3f direction = sample_direction(u, {});
  const float pdf = length_sq(direction) > 0 ? direction_pdf(direction, {}) : 0.0f;
  if (!(pdf > 0)) return {{0, 0, 1}, pdf};
  return {-direction, pdf};
}

}  // namespace kaustik
