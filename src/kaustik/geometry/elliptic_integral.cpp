#include "kaustik/geometry/elliptic_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kaustik {
namespace {

/// How far apart the arguments may be for the series: its first term left out has their sixth
/// power.
constexpr double series_spread = 2e-3;

bool are_near(double x, double y, double z, double mean) {
  return std::max({std::fabs(x - mean), std::fabs(y - mean), std::fabs(z - mean)}) <
         series_spread * mean;
}

/// Brings the arguments nearer to one another; returns what is added to each of them.
double duplicate(double& x, double& y, double& z) {
  const double roots[3] = {std::sqrt(x), std::sqrt(y), std::sqrt(z)};
  const double sum = roots[0] * roots[1] + roots[1] * roots[2] + roots[2] * roots[0];
  for (double* argument : {&x, &y, &z}) *argument = 0.25 * (*argument + sum);
  return sum;
}

double carlson_rf(double x, double y, double z) {
  double mean = (x + y + z) / 3;
  while (!are_near(x, y, z, mean)) {
    duplicate(x, y, z);
    mean = (x + y + z) / 3;
  }
  const double a = 1 - x / mean, b = 1 - y / mean, c = -(a + b);
  const double e2 = a * b - c * c, e3 = a * b * c;
  return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / std::sqrt(mean);
}

double carlson_rd(double x, double y, double z) {
  double sum = 0, factor = 1;
  double mean = (x + y + 3 * z) / 5;
  while (!are_near(x, y, z, mean)) {
    const double before = z;
    const double added = duplicate(x, y, z);
    sum += factor / (std::sqrt(before) * (before + added));
    factor *= 0.25;
    mean = (x + y + 3 * z) / 5;
  }
  const double a = 1 - x / mean, b = 1 - y / mean, c = -(a + b) / 3;
  const double e2 = a * b - 6 * c * c, e3 = (3 * a * b - 8 * c * c) * c;
  const double e4 = 3 * (a * b - c * c) * c * c, e5 = a * b * c * c * c;
  const double series =
      1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  return 3 * sum + factor * series / (mean * std::sqrt(mean));
}

}  // namespace

double carlson_rg(double x, double y, double z) {
  std::array<double, 3> in_order = {x, y, z};
  std::sort(in_order.begin(), in_order.end());
  const auto [low, middle, high] = in_order;
  if (!(middle > 0)) return 0.5 * std::sqrt(high);
  // With the middle one apart no two terms have different signs.
  return 0.5 * (middle * carlson_rf(low, high, middle) +
                (high - middle) * (middle - low) * carlson_rd(low, high, middle) / 3 +
                std::sqrt(low * (high / middle)));
}

}  // namespace kaustik
