#include "kaustik/image/vision.h"

#include <algorithm>
#include <cmath>

#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

constexpr float rods_alone = 5.6e-3f, cones_alone = 5.6f;

float scotopic_unscaled(const Vec3f& rgb) {
  const Vec3f xyz = xyz_from_rgb(rgb);
  if (!(xyz.x > 0) || !(xyz.y > 0)) return 0;
  return std::max(0.0f, xyz.y * (1.33f * (1 + (xyz.y + xyz.z) / xyz.x) - 1.68f));
}

}  // namespace

double visible_difference(double adaptation) {
  const double x = adaptation > 0 ? std::log10(adaptation) : -infinity;
  double exponent;
  if (x < -3.94)
    exponent = -2.86;
  else if (x < -1.44)
    exponent = std::pow(0.405 * x + 1.6, 2.18) - 2.86;
  else if (x < -0.0184)
    exponent = x - 0.395;
  else if (x < 1.9)
    exponent = std::pow(0.249 * x + 0.65, 2.7) - 0.72;
  else
    exponent = x - 1.255;
  return std::pow(10.0, exponent);
}

double visual_acuity(double adaptation) {
  constexpr double darkest = 1e-6;
  const double x = std::log10(adaptation > darkest ? adaptation : darkest);
  return 17.25 * std::atan(1.4 * x + 0.35) + 25.72;
}

float cone_share(float luminance) {
  return std::clamp((luminance - rods_alone) / (cones_alone - rods_alone), 0.0f, 1.0f);
}

float scotopic(const Vec3f& rgb) {
  static const float of_white = scotopic_unscaled(Vec3f(1));
  return scotopic_unscaled(rgb) / of_white;
}

Vec3f seen_color(const Vec3f& rgb) {
  const float share = cone_share(luminance(rgb));
  return share == 1 ? rgb : rgb * share + Vec3f((1 - share) * scotopic(rgb));
}

}  // namespace kaustik
