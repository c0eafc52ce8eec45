#include "kaustik/irradiance/record_reach.h"

namespace kaustik {
namespace {

constexpr float most_turning = 1e4f;  ///< also of what is not finite

/// What relative errors are relative to.
float size_of(const Spectrum& irradiance) { return std::sqrt((irradiance * irradiance).sum()); }

}  // namespace

float split_sphere_radius(const HemisphereEstimate& estimate, bool minimum_distance) {
  return minimum_distance ? estimate.minimum_distance : estimate.harmonic_distance;
}

float gradient_radius(const HemisphereEstimate& estimate) {
  float gradients = 0;
  for (const Vec3f& gradient : estimate.translation_gradient) gradients += length(gradient);
  return gradients > 0 ? std::max(0.0f, estimate.irradiance.sum()) / gradients : infinity;
}

float turning_factor(const HemisphereEstimate& estimate) {
  float gradients = 0;
  for (const Vec3f& gradient : estimate.rotation_gradient) gradients += length(gradient);
  const float irradiance = std::max(estimate.irradiance.sum(), 1e-30f);
  const float factor = 2 * sqr(gradients / irradiance);
  return factor < most_turning ? std::max(factor, 1.0f) : most_turning;
}

Validity hessian_validity(const HemisphereEstimate& estimate, const Vec3f& normal,
                          float pixel_width) {
  // The square root of Σ Hᵀ H over the lanes has the eigenvalues λ₁ ≥ λ₂ ≥ 0.
  const TangentHessian& h = estimate.translation_hessian;
  const double scale = double(std::max(size_of(estimate.irradiance), 1e-30f));
  double xx = 0, xy = 0, yy = 0;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const double a = double(h.xx[lane]) / scale, b = double(h.xy[lane]) / scale,
                 c = double(h.yy[lane]) / scale;
    xx += a * a + b * b;
    xy += b * (a + c);
    yy += b * b + c * c;
  }
  const double mean = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
  if (!std::isfinite(half)) return {0, 1, Vec3f(0, 0, 0)};
  const double largest = std::sqrt(mean + half);
  if (!(largest > 0)) return {};
  const double least = largest / double(sqr(greatest_aspect));
  const double smallest = std::max(std::sqrt(std::max(0.0, mean - half)), least);
  Validity validity;
  validity.aspect = float(std::sqrt(largest / smallest));
  // (π/4) λ₁ r₁³ r₂/w² with r₂ = aspect r₁.
  validity.radius = float(std::pow(4 * double(total_error_scale) * double(sqr(pixel_width)) /
                                       (double(pi) * largest * double(validity.aspect)),
                                   0.25));
  const double turn = 0.5 * std::atan2(xy, 0.5 * (xx - yy));
  const Frame frame(normal);
  validity.axis = frame.x * float(std::cos(turn)) + frame.y * float(std::sin(turn));
  return validity;
}

}  // namespace kaustik
