#include "kaustik/medium/medium.h"

#include <gtest/gtest.h>

#include "kaustik/base/vec.h"

namespace kaustik {
namespace {

TEST(absorbing_medium, follows_beer_and_lambert) {
  const AbsorbingMedium medium(Spectrum(0, 0.5f, 2, 1));
  const Spectrum t = medium.transmittance(1.5f);
  EXPECT_EQ(t[0], 1);
  EXPECT_FLOAT_EQ(t[1], std::exp(-0.75f));
  EXPECT_FLOAT_EQ(t[2], std::exp(-3.0f));
  const Spectrum two = medium.transmittance(0.7f) * medium.transmittance(0.8f);
  for (int lane = 0; lane < 4; ++lane) EXPECT_NEAR(two[lane], t[lane], 1e-6f);
}

TEST(absorbing_medium, at_the_ends) {
  const AbsorbingMedium medium(Spectrum(0, 0.5f, 2, 1));
  EXPECT_EQ(medium.transmittance(0), Spectrum(1));
  EXPECT_EQ(medium.transmittance(infinity), Spectrum(1, 0, 0, 0));
}

}  // namespace
}  // namespace kaustik
