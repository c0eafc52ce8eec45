#pragma once
#include <array>

#include "kaustik/base/vec.h"

namespace kaustik {

/// The irradiance that an environment gives to surfaces of any orientation, by its first nine
/// spherical harmonics, which leave out about a hundredth of it (Ramamoorthi and Hanrahan, "An
/// Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001, eqs. 7 to 12).
class IrradianceHarmonics {
 public:
  /// Adds radiance from a direction, weighted by solid angle.
  void add(const Vec3f& direction, double radiance_times_solid_angle);

  /// On the side of a surface that its normal points to; at least a twentieth of the mean over all
  /// orientations. For a zero normal the integral over all directions.
  float irradiance(const Vec3f& normal) const;

 private:
  std::array<double, 9> coefficients_{};
};

}  // namespace kaustik
