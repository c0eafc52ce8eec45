#include "kaustik/image/photometry.h"

#include "tests/image/support.h"

namespace kaustik {
namespace {

TEST(Photometry, white_of_unit_radiance_has_179_candelas) {
  EXPECT_NEAR(photopic(Vec3f(1)), 1, 1e-6);
  EXPECT_NEAR(luminance(Vec3f(2)), 358, 1e-3);
}

TEST(Photometry, white_is_d65) {
  const Vec3f white = xyz_from_rgb(Vec3f(1));
  const float sum = white.x + white.y + white.z;
  EXPECT_NEAR(white.x / sum, 0.3127, 1e-5);
  EXPECT_NEAR(white.y / sum, 0.3290, 1e-5);
}

TEST(Photometry, primaries_are_those_of_rec_709) {
  const double wanted[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  for (int c = 0; c < 3; ++c) {
    Vec3f rgb(0);
    rgb[c] = 1;
    const Vec3f xyz = xyz_from_rgb(rgb);
    const float sum = xyz.x + xyz.y + xyz.z;
    EXPECT_NEAR(xyz.x / sum, wanted[c][0], 1e-5);
    EXPECT_NEAR(xyz.y / sum, wanted[c][1], 1e-5);
    const Vec3f back = rgb_from_xyz(xyz);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], rgb[i], 2e-6);
  }
}

TEST(Photometry, srgb_curve) {
  EXPECT_EQ(srgb_from_linear(0), 0);
  EXPECT_NEAR(srgb_from_linear(1), 1, 1e-6);
  EXPECT_NEAR(srgb_from_linear(0.5f), 0.735357, 1e-5);
  EXPECT_NEAR(srgb_from_linear(0.002f), 0.02584, 1e-6);
  for (float x = -2; x <= 2; x += 0.01f)
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(x)), x, 3e-6);
}

}  // namespace
}  // namespace kaustik
