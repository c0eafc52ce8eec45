#include "kaustik/light/spot_cone.h"

namespace kaustik {
namespace {

/// 1 − cosθ without cancellation.
double height_of_angle(double angle) {
  const double s = std::sin(0.5 * angle);
  return 2 * s * s;
}

float height_of(const Vec3f& local) {
  if (local.z <= 0) return 1.0f - local.z;
  return (sqr(local.x) + sqr(local.y)) / (1.0f + local.z);
}

/// ∫ falloff dω = 2π (1 − (sin c − sin b)/(c − b)) for cutoff c and beam b.
double solid_angle_of_falloff(double cutoff, double beam) {
  const double middle = 0.5 * (cutoff + beam), half = 0.5 * (cutoff - beam);
  // sin c − sin b = 2 cos(middle) sin(half), so that the quotient is cos(middle) sinc(half).
  const double one_minus_sinc = half < 1e-3 ? half * half / 6 : 1 - std::sin(half) / half;
  const double one_minus_cos = height_of_angle(middle);
  return 2 * std::numbers::pi * (one_minus_cos + (1 - one_minus_cos) * one_minus_sinc);
}

double solid_angle_of(SpotFalloff falloff, double cutoff, double beam) {
  if (falloff == SpotFalloff::linear) return solid_angle_of_falloff(cutoff, beam);
  // ∫ (3t² − 2t³) dt = 1/2 and ∫ t² dt = 1/3 over the transition.
  const double beam_height = height_of_angle(beam), rest = height_of_angle(cutoff) - beam_height;
  return 2 * std::numbers::pi *
         (beam_height + rest * (falloff == SpotFalloff::smooth ? 0.5 : 1.0 / 3));
}

/// Transitions from beam to cutoff that a ramp of the sine follows: others are too narrow for the
/// rounding of directions, or so wide that the sine turns back.
constexpr double least_ramp = 0.02, most_ramp = 0.5 * std::numbers::pi;

}  // namespace

SpotCone::SpotCone(double cutoff, double beam, SpotFalloff falloff)
    : kind_(falloff),
      cutoff_(float(cutoff)),
      inv_transition_(cutoff > beam ? float(1 / (cutoff - beam)) : 0.0f),
      beam_height_(float(height_of_angle(beam))),
      cutoff_height_(float(height_of_angle(cutoff))),
      mass_(0.5f * (beam_height_ + cutoff_height_)),
      solid_angle_(float(solid_angle_of(falloff, cutoff, beam))) {}

EmissionBall SpotCone::emission_ball(const Bounds3f& position, const Vec3f& axis,
                                     double intensity) const {
  const double width = inv_transition_ > 0 ? 1.0 / double(inv_transition_) : 0.0;
  const bool ramp = kind_ == SpotFalloff::linear && width >= least_ramp && width <= most_ramp;
  EmissionCone cone{axis, double(cutoff_), 0};
  if (ramp) cone = {axis, double(cutoff_) - width, width};
  EmissionBall ball(position, cone, intensity);
  if (ramp) ball.ramp = float(1 / std::sin(width));
  return ball;
}

float SpotCone::falloff(const Vec3f& local) const {
  const float height = height_of(local);
  if (height >= cutoff_height_) return 0;
  if (height <= beam_height_) return 1;
  if (kind_ != SpotFalloff::linear) {
    const float t = share_at(height);
    return kind_ == SpotFalloff::smooth ? t * t * (3.0f - 2.0f * t) : t * t;
  }
  const float angle = std::atan2(std::sqrt(sqr(local.x) + sqr(local.y)), local.z);
  return std::clamp((cutoff_ - angle) * inv_transition_, 0.0f, 1.0f);
}

Vec3f SpotCone::sample(const Vec2f& u) const {
  const float target = u.x * mass_;
  float height = target;
  if (target > beam_height_) {
    // The rest of the mass, a triangle from the beam to the cutoff, counted from its far end.
    const float width = cutoff_height_ - beam_height_;
    const float rest = (mass_ - target) * 2.0f * width;
    height = std::max(beam_height_, cutoff_height_ - safe_sqrt(rest));
  }
  const float r = safe_sqrt(height * (2.0f - height));
  const float phi = 2.0f * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), 1.0f - height};
}

float SpotCone::pdf(const Vec3f& local) const { return pdf_at(height_of(local)); }

float SpotCone::pdf_at(float height) const {
  if (height >= cutoff_height_) return 0;
  const float shape = height <= beam_height_ ? 1.0f : share_at(height);
  return shape / (2.0f * pi * mass_);
}

}  // namespace kaustik
