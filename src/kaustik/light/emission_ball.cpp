#include "kaustik/light/emission_ball.h"

#include "kaustik/base/vectorize.h"

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

// Conty Estevez and Kulla, eq. 4, for the sphere around the lights, whose angular radius is
// θ_u: intensity · |cos max(0, θ_i − θ_u)| · cos max(0, θ − θ_o − θ_u) / d². Without branches, so
// that compilers make vectors of it.
inline float irradiance_of_ball(const Vec3f& reference, const Vec3f& normal, float center_x,
                                float center_y, float center_z, float radius, float axis_x,
                                float axis_y, float axis_z, float cos_spread, float sin_spread,
                                float cos_falloff, float intensity) {
  const float x = reference.x - center_x, y = reference.y - center_y, z = reference.z - center_z;
  const float distance_sq = x * x + y * y + z * z;
  const float radius_sq = radius * radius;
  // Within the sphere a mean distance stands for all: that of points spread evenly over a box from
  // its centre is a third of radius². A quarter gave the least variance, a whole four times that.
  const float base = intensity / std::max(std::max(distance_sq, 0.25f * radius_sq), 1e-20f);

  const float inverse = 1.0f / std::sqrt(std::max(distance_sq, 1e-30f));
  const float sin_u_sq = std::min(1.0f, radius_sq * (inverse * inverse));
  const float sin_u = std::sqrt(sin_u_sq), cos_u = std::sqrt(1.0f - sin_u_sq);
  const auto sine_of = [](float cosine) {
    return std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
  };
  const auto within_one = [](float cosine) { return std::min(1.0f, std::max(-1.0f, cosine)); };

  const float cos_axis = within_one((axis_x * x + axis_y * y + axis_z * z) * inverse);
  const float sin_axis = sine_of(cos_axis);
  const float cos_x = cos_of_difference(cos_axis, sin_axis, cos_spread, sin_spread);
  const float sin_x = sin_of_difference(cos_axis, sin_axis, cos_spread, sin_spread);
  const float cos_emission = cos_of_difference(cos_x, sin_x, cos_u, sin_u);

  const bool any_side = normal.x == 0 && normal.y == 0 && normal.z == 0;
  const float cos_i = within_one(-(normal.x * x + normal.y * y + normal.z * z) * inverse);
  const float facing = cos_of_difference(cos_i, sine_of(cos_i), cos_u, sin_u);
  const float cos_receiver = any_side ? 1.0f : facing;

  const float outside =
      base * std::max(cos_emission, cosine_slack) * std::max(cos_receiver, minimum_receiver_cosine);
  // Beyond its cone, or wholly behind the surface.
  const float lit = cos_emission < cos_falloff - cosine_slack ? 0.0f : outside;
  const float before = cos_receiver < -cosine_slack ? 0.0f : lit;
  return distance_sq <= radius_sq ? base : before;
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

float EmissionBall::irradiance(const Vec3f& reference, const Vec3f& normal) const {
  return irradiance_of_ball(reference, normal, center.x, center.y, center.z, radius, axis.x, axis.y,
                            axis.z, cos_spread, sin_spread, cos_falloff, intensity);
}

void EmissionBalls::add(const EmissionBall& ball) {
  for (int k = 0; k < 3; ++k) {
    center_[k].push_back(ball.center[k]);
    axis_[k].push_back(ball.axis[k]);
  }
  radius_.push_back(ball.radius);
  cos_spread_.push_back(ball.cos_spread);
  sin_spread_.push_back(ball.sin_spread);
  cos_falloff_.push_back(ball.cos_falloff);
  intensity_.push_back(ball.intensity);
}

void EmissionBalls::irradiance(const Vec3f& reference, const Vec3f& normal, float* result) const {
  const float *cx = center_[0].data(), *cy = center_[1].data(), *cz = center_[2].data();
  const float *ax = axis_[0].data(), *ay = axis_[1].data(), *az = axis_[2].data();
  const float *radius = radius_.data(), *cos_spread = cos_spread_.data();
  const float *sin_spread = sin_spread_.data(), *cos_falloff = cos_falloff_.data();
  const float* intensity = intensity_.data();
  const size_t count = size();
  KAUSTIK_INDEPENDENT_TURNS
  for (size_t i = 0; i < count; ++i)
    result[i] =
        irradiance_of_ball(reference, normal, cx[i], cy[i], cz[i], radius[i], ax[i], ay[i], az[i],
                           cos_spread[i], sin_spread[i], cos_falloff[i], intensity[i]);
}

}  // namespace kaustik
