#include "kaustik/base/fast_math.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

TEST(FastMath, ApproximateAtan2IsNearTheLibrary) {
  for (int i = 0; i < 20000; ++i) {
    const float angle = -pi + 2 * pi * (float(i) + 0.5f) / 20000;
    const float r = std::exp(float(i % 41) - 20);
    EXPECT_NEAR(approximate_atan2(r * std::sin(angle), r * std::cos(angle)), angle, 3e-6f);
  }
  EXPECT_EQ(approximate_atan2(0, 0), 0);
  EXPECT_EQ(approximate_atan2(0, 1), 0);
  EXPECT_FLOAT_EQ(approximate_atan2(0, -1), pi);
}

TEST(FastMath, ApproximateLogIsNearTheLibrary) {
  for (float x = 1.2e-38f; x < 3e38f; x *= 1.0003f) {
    const double expected = std::log(double(x));
    ASSERT_NEAR(double(approximate_log(x)), expected, 2e-7 * (1 + std::fabs(expected))) << x;
  }
  for (int i = 1; i < 1 << 20; ++i) {
    const float x = 1 - float(i) * 0x1p-24f;
    ASSERT_NEAR(approximate_log(x) / std::log(double(x)), 1, 2e-7) << x;
  }
  EXPECT_EQ(approximate_log(1), 0);
}

}  // namespace
}  // namespace kaustik
