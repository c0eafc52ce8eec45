#include "kaustik/base/gap_split.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kaustik {
namespace {

TEST(SplitInGap, HalvesWhatIsSpread) {
  EXPECT_EQ(split_in_gap({4, 1, 3, 2}, 0), 2.5f);
  EXPECT_EQ(split_in_gap({3, 1, 2}, 0), 1.5f);
}

/// What lies in one plane but for rounding stays together, whatever end it is at.
TEST(SplitInGap, LeavesPlanesWhole) {
  EXPECT_NEAR(split_in_gap({0, 2, 2, 1.9999999f, 2, 2.0000002f}, 1e-5f).value(), 1, 1e-6);
  EXPECT_NEAR(split_in_gap({0, 0, 1e-7f, 0, 2}, 1e-5f).value(), 1, 1e-6);
  EXPECT_EQ(split_in_gap({0, 0, 1, 1, 1, 1, 1, 3, 3, 3}, 1e-5f), 2);
}

TEST(SplitInGap, IsNoneWithoutGap) {
  EXPECT_FALSE(split_in_gap({}, 0));
  // Of floats that are neighbours the larger one divides them.
  const float next = std::nextafter(1.0f, 2.0f);
  EXPECT_EQ(split_in_gap({1, next}, 0), next);
  EXPECT_FALSE(split_in_gap({1}, 0));
  EXPECT_FALSE(split_in_gap({1, 1, 1}, 0));
  EXPECT_FALSE(split_in_gap({0, 0.5f, 1}, 0.5f));
}

}  // namespace
}  // namespace kaustik
