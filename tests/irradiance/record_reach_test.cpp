#include "kaustik/irradiance/record_reach.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

constexpr float pixel = 0.02f;

HemisphereEstimate estimate_with(const Spectrum& irradiance, const TangentHessian& hessian) {
  HemisphereEstimate estimate;
  estimate.irradiance = irradiance;
  estimate.translation_hessian = hessian;
  return estimate;
}

/// ∫ ½ |Δxᵀ H Δx|/E over an ellipse with the radii r along `axis` and aspect·r across it, in
/// pixels; H and E of lane 0, in the frame of +z.
double total_error(const HemisphereEstimate& e, const Validity& validity, double r) {
  const int steps = 400;
  const double a = double(validity.axis.x), b = double(validity.axis.y);
  const TangentHessian& h = e.translation_hessian;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double u = 2 * (i + 0.5) / steps - 1, v = 2 * (j + 0.5) / steps - 1;
      if (u * u + v * v > 1) continue;
      const double along = u * r, across = v * r * double(validity.aspect);
      const double x = along * a - across * b, y = along * b + across * a;
      sum += 0.5 * std::fabs(double(h.xx[0]) * x * x + 2 * double(h.xy[0]) * x * y +
                             double(h.yy[0]) * y * y);
    }
  const double area = 4 * r * r * double(validity.aspect) / (steps * steps);
  return sum * area / double(e.irradiance[0]) / double(pixel * pixel);
}

TEST(hessian_validity, allows_the_total_error) {
  // The main axes at an angle of 30° to the frame's.
  const float c = std::cos(pi / 6), s = std::sin(pi / 6);
  for (const float second : {8.0f, 2.0f}) {
    const float first = 8;
    const TangentHessian h{Spectrum(first * c * c + second * s * s, 0, 0, 0),
                           Spectrum((first - second) * c * s, 0, 0, 0),
                           Spectrum(first * s * s + second * c * c, 0, 0, 0)};
    const auto e = estimate_with(Spectrum(3, 0, 0, 0), h);
    const Validity validity = hessian_validity(e, Vec3f(0, 0, 1), pixel);
    EXPECT_NEAR(validity.aspect, std::sqrt(first / second), 1e-5f);
    if (second < first) {
      EXPECT_NEAR(std::fabs(dot(validity.axis, Vec3f(c, s, 0))), 1, 1e-5f);
    }
    for (const double quality : {0.1, 0.3}) {
      const double allowed = double(total_error_scale) * std::pow(quality, 4);
      const double total = total_error(e, validity, quality * double(validity.radius));
      EXPECT_NEAR(total / allowed, 1, 0.005);
      EXPECT_GT(
          std::fabs(total_error(e, validity, 1.02 * quality * double(validity.radius)) / allowed -
                    1),
          0.005);
    }
  }
}

TEST(hessian_validity, rim_of_the_ellipse_has_one_error) {
  const auto e = estimate_with(Spectrum(1), {Spectrum(5), Spectrum(0), Spectrum(-2)});
  const Validity v = hessian_validity(e, Vec3f(0, 0, 1), pixel);
  EXPECT_NEAR(5 * sqr(v.radius), 2 * sqr(v.aspect * v.radius), 1e-4f * sqr(v.radius));
}

TEST(hessian_validity, colours_do_not_cancel) {
  const Spectrum up_and_down(4, -4, 0, 0);
  const auto e = estimate_with(Spectrum(1, 1, 0, 0), {up_and_down, Spectrum(), up_and_down});
  const auto same =
      estimate_with(Spectrum(1, 1, 0, 0), {Spectrum(4, 4, 0, 0), Spectrum(), Spectrum(4, 4, 0, 0)});
  const Vec3f n(0, 0, 1);
  EXPECT_EQ(hessian_validity(e, n, pixel).radius, hessian_validity(same, n, pixel).radius);
}

TEST(hessian_validity, depends_on_neither_units_nor_resolution_beyond_reason) {
  const TangentHessian h{Spectrum(5), Spectrum(1), Spectrum(-1)};
  const TangentHessian brighter{Spectrum(500), Spectrum(100), Spectrum(-100)};
  const Vec3f n(0, 0, 1);
  const Validity v = hessian_validity(estimate_with(Spectrum(1), h), n, pixel);
  const Validity w = hessian_validity(estimate_with(Spectrum(100), brighter), n, pixel);
  EXPECT_NEAR(v.radius, w.radius, 1e-5f * v.radius);
  const Validity finer = hessian_validity(estimate_with(Spectrum(1), h), n, pixel / 4);
  EXPECT_NEAR(finer.radius, v.radius / 2, 1e-5f * v.radius);
}

TEST(hessian_validity, limits) {
  const Vec3f n(0, 0, 1);
  const auto flat = hessian_validity(estimate_with(Spectrum(1), {}), n, pixel);
  EXPECT_EQ(flat.radius, infinity);
  EXPECT_EQ(flat.aspect, 1);
  const auto ridge = estimate_with(Spectrum(1), {Spectrum(1), Spectrum(), Spectrum()});
  EXPECT_NEAR(hessian_validity(ridge, n, pixel).aspect, greatest_aspect, 1e-5f);
  const auto dark = estimate_with(Spectrum(0), {Spectrum(1), Spectrum(), Spectrum()});
  EXPECT_LT(hessian_validity(dark, n, pixel).radius, 1e-3f);
  const auto broken = estimate_with(Spectrum(1), {Spectrum(std::nanf("")), Spectrum(), Spectrum()});
  EXPECT_EQ(hessian_validity(broken, n, pixel).radius, 0);
}

}  // namespace
}  // namespace kaustik
