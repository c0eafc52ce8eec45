#include "kaustik/light/emission_ball.h"

namespace kaustik {
namespace {

/// Rounding of directions must not hide a light at the border of its cone.
constexpr float cosine_slack = 1e-4f;

/// cos max(0, a − b) of angles within [0, π].
float cos_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}
/// sin max(0, a − b).
float sin_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 0.0f : sin_a * cos_b - cos_a * sin_b;
}

}  // namespace

EmissionBall::EmissionBall(const LightBounds& bounds, double power)
    : EmissionBall(bounds.position, emission_cone(bounds),
                   power / orientation_measure(emission_cone(bounds))) {}

EmissionBall::EmissionBall(const Bounds3f& position, const EmissionCone& cone, double brightest)
    : center(kaustik::center(position)),
      radius(bounding_radius(position) * (1.0f + 1e-5f)),
      axis(cone.axis),
      cos_spread(float(std::cos(cone.spread))),
      sin_spread(float(std::sin(cone.spread))),
      cos_falloff(float(std::cos(cone.falloff))),
      intensity(std::max(float(brightest), std::numeric_limits<float>::min())) {}

// Conty Estevez and Kulla, eq. 4, for the sphere around the lights, whose angular radius is
// θ_u: intensity · |cos max(0, θ_i − θ_u)| · cos max(0, θ − θ_o − θ_u) / d².
float EmissionBall::irradiance(const Vec3f& reference, const Vec3f& normal) const {
  const Vec3f to_reference = reference - center;
  const float distance_sq = length_sq(to_reference);
  const float radius_sq = sqr(radius);
  // Within the sphere a mean distance stands for all: that of points spread evenly over a box from
  // its centre is a third of radius². A quarter gave the least variance, a whole four times that.
  const float base = intensity / std::max({distance_sq, 0.25f * radius_sq, 1e-20f});
  if (distance_sq <= radius_sq || distance_sq == 0) return base;

  const Vec3f direction = to_reference * (1.0f / std::sqrt(distance_sq));
  const float sin_u_sq = radius_sq / distance_sq;
  const float sin_u = std::sqrt(sin_u_sq), cos_u = safe_sqrt(1.0f - sin_u_sq);

  const float cos_axis = std::clamp(dot(axis, direction), -1.0f, 1.0f);
  const float sin_axis = safe_sqrt(1.0f - sqr(cos_axis));
  const float cos_x = cos_of_difference(cos_axis, sin_axis, cos_spread, sin_spread);
  const float sin_x = sin_of_difference(cos_axis, sin_axis, cos_spread, sin_spread);
  const float cos_emission = cos_of_difference(cos_x, sin_x, cos_u, sin_u);
  if (cos_emission < cos_falloff - cosine_slack) return 0;

  float cos_receiver = 1;
  if (normal.x != 0 || normal.y != 0 || normal.z != 0) {
    const float cos_i = std::clamp(-dot(normal, direction), -1.0f, 1.0f);
    cos_receiver = cos_of_difference(cos_i, safe_sqrt(1.0f - sqr(cos_i)), cos_u, sin_u);
    if (cos_receiver < -cosine_slack) return 0;  // wholly behind the surface
    cos_receiver = std::max(cos_receiver, minimum_receiver_cosine);
  }
  return base * std::max(cos_emission, cosine_slack) * cos_receiver;
}

}  // namespace kaustik
