#include "kaustik/light/irradiance_harmonics.h"

namespace kaustik {
namespace {

/// The real spherical harmonics up to degree 2: constant, then y, z, x, then xy, yz, 3z² − 1, xz,
/// x² − y².
std::array<double, 9> harmonics(const Vec3f& n) {
  const double x = n.x, y = n.y, z = n.z;
  return {0.282095,
          0.488603 * y,
          0.488603 * z,
          0.488603 * x,
          1.092548 * x * y,
          1.092548 * y * z,
          0.315392 * (3 * z * z - 1),
          1.092548 * x * z,
          0.546274 * (x * x - y * y)};
}

}  // namespace

void IrradianceHarmonics::add(const Vec3f& direction, double radiance_times_solid_angle) {
  const std::array<double, 9> y = harmonics(direction);
  for (size_t i = 0; i < 9; ++i) coefficients_[i] += y[i] * radiance_times_solid_angle;
}

float IrradianceHarmonics::irradiance(const Vec3f& normal) const {
  const double total = coefficients_[0] / 0.282095;
  if (normal == Vec3f(0, 0, 0)) return float(total);
  // The harmonics of the clamped cosine, per degree.
  constexpr double degree_0 = std::numbers::pi, degree_1 = 2 * std::numbers::pi / 3,
                   degree_2 = std::numbers::pi / 4;
  const std::array<double, 9> y = harmonics(normal);
  double irradiance = degree_0 * coefficients_[0] * y[0];
  for (size_t i = 1; i < 4; ++i) irradiance += degree_1 * coefficients_[i] * y[i];
  for (size_t i = 4; i < 9; ++i) irradiance += degree_2 * coefficients_[i] * y[i];
  return float(std::max(irradiance, 0.05 * 0.25 * total));
}

}  // namespace kaustik
