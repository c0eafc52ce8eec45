#include <gtest/gtest.h>

#include "kaustik/irradiance/record_reach.h"

namespace kaustik {
namespace {

HemisphereEstimate with_gradient(float irradiance, float per_radian) {
  HemisphereEstimate estimate;
  estimate.irradiance = Spectrum(irradiance);
  for (Vec3f& gradient : estimate.rotation_gradient) gradient = {per_radian, 0, 0};
  return estimate;
}

/// Irradiance cos θ of a lamp far away, at 45°: the gradient is as large as the irradiance.
TEST(turning_factor, closed_forms) {
  EXPECT_EQ(turning_factor(with_gradient(1, 0)), 1);
  EXPECT_EQ(turning_factor(with_gradient(1, 0.5f)), 1);
  EXPECT_FLOAT_EQ(turning_factor(with_gradient(1, 1)), 2);
  EXPECT_FLOAT_EQ(turning_factor(with_gradient(0.1f, 0.4f)), 32);
}
TEST(turning_factor, limits) {
  const float most = turning_factor(with_gradient(0, 1));
  EXPECT_TRUE(std::isfinite(most));
  EXPECT_EQ(turning_factor(with_gradient(1, infinity)), most);
  EXPECT_EQ(turning_factor(with_gradient(1, std::nanf(""))), most);
  EXPECT_EQ(turning_factor(with_gradient(0, 0)), 1);
}

}  // namespace
}  // namespace kaustik
