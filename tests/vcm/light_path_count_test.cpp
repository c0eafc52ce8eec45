#include <gtest/gtest.h>

#include "kaustik/vcm/plan/plans.h"

namespace kaustik {
namespace {

// Vertices of light paths are what a pass keeps in memory.
TEST(LightPathCount, IsBoundedHoweverManySamplesAPassHas) {
  EXPECT_EQ(light_path_count({200, 200}, 4, 0.25f), 40000u);
  EXPECT_EQ(light_path_count({200, 200}, 64, 0.25f), 640000u);
  EXPECT_EQ(light_path_count({200, 200}, 1 << 30, 1), 1u << 21);
  EXPECT_EQ(light_path_count({1, 1}, 1, 0.01f), 1u);
  // Passes of the usual samples have what they ask for, as far as memory may go.
  EXPECT_EQ(light_path_count({2000, 2000}, 4, 1), 16000000u);
  EXPECT_EQ(light_path_count({2000, 2000}, 400, 1), 16000000u);
  EXPECT_EQ(light_path_count({8000, 8000}, 4, 1), 1u << 24);
}

}  // namespace
}  // namespace kaustik
