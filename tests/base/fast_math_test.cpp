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

}  // namespace
}  // namespace kaustik
