#include "kaustik/base/color.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

TEST(color, observer_at_its_peaks) {
  EXPECT_DOUBLE_EQ(cie_xyz_at(555).y, 1.0);
  EXPECT_NEAR(cie_xyz_at(600).x, 1.0622, 1e-6);
  EXPECT_NEAR(cie_xyz_at(445).z, 1.7826, 1e-3);
  // Between the rows: within a thousandth of the table in steps of 1 nm.
  EXPECT_NEAR(cie_xyz_at(507).y, 0.4441, 3e-3);
  EXPECT_EQ(cie_xyz_at(359.9), Vec3d(0, 0, 0));
  EXPECT_EQ(cie_xyz_at(830.1), Vec3d(0, 0, 0));
  EXPECT_GT(cie_xyz_at(830).y, 0);
}

TEST(color, observer_sees_equal_energy_as_white) {
  Vec3d sum(0, 0, 0);
  for (int nm = 360; nm <= 830; ++nm) sum += cie_xyz_at(nm);
  EXPECT_NEAR(sum.x, 106.865, 0.05);
  EXPECT_NEAR(sum.y, 106.857, 0.05);
  EXPECT_NEAR(sum.z, 106.892, 0.05);
}

TEST(color, daylight) {
  EXPECT_DOUBLE_EQ(d65_at(560), 100);
  EXPECT_DOUBLE_EQ(d65_at(300), 0.0341);
  EXPECT_EQ(d65_at(299), 0);
  EXPECT_EQ(d65_at(831), 0);
  Vec3d sum(0, 0, 0);
  for (int nm = 360; nm <= 830; ++nm) sum += cie_xyz_at(nm) * d65_at(nm);
  EXPECT_NEAR(sum.x / (sum.x + sum.y + sum.z), 0.31272, 5e-5);
  EXPECT_NEAR(sum.y / (sum.x + sum.y + sum.z), 0.32903, 5e-5);
}

TEST(color, primaries_of_rec_709) {
  const auto expect_rgb = [](const Rgb& c, double r, double g, double b) {
    EXPECT_NEAR(c.r, r, 2e-3);
    EXPECT_NEAR(c.g, g, 2e-3);
    EXPECT_NEAR(c.b, b, 2e-3);
  };
  expect_rgb(rgb_from_xyz({0.95047, 1.0, 1.08883}), 1, 1, 1);
  expect_rgb(rgb_from_xyz({0.4124, 0.2126, 0.0193}), 1, 0, 0);
  expect_rgb(rgb_from_xyz({0.3576, 0.7152, 0.1192}), 0, 1, 0);
  expect_rgb(rgb_from_xyz({0.1805, 0.0722, 0.9505}), 0, 0, 1);
}

TEST(color, constant_reflectance_is_grey) {
  for (const double value : {0.0, 0.18, 1.0}) {
    const Rgb c = rgb_from_reflectance({{{360, value}, {830, value}}});
    EXPECT_NEAR(c.r, value, 1e-12);
    EXPECT_NEAR(c.g, value, 1e-12);
    EXPECT_NEAR(c.b, value, 1e-12);
  }
}

TEST(color, reflectance_of_one_end_has_its_colour_and_no_negative_lane) {
  const Rgb red = rgb_from_reflectance({{{600, 0}, {601, 1}, {830, 1}}});
  EXPECT_GT(red.r, 0.5);
  EXPECT_EQ(red.g, 0);
  EXPECT_GE(red.b, 0);
  const Rgb blue = rgb_from_reflectance({{{360, 1}, {490, 1}, {491, 0}}});
  EXPECT_GT(blue.b, 0.7);
  EXPECT_LT(blue.g, 0.2);
  EXPECT_EQ(blue.r, 0);
}

TEST(color, reflectances_add) {
  // Two halves of white make white, as long as no lane is clamped.
  const SpectralCurve rise{{{360, 0.2}, {830, 0.8}}}, fall{{{360, 0.8}, {830, 0.2}}};
  const Rgb a = rgb_from_reflectance(rise), b = rgb_from_reflectance(fall);
  EXPECT_NEAR(a.r + b.r, 1, 1e-12);
  EXPECT_NEAR(a.g + b.g, 1, 1e-12);
  EXPECT_NEAR(a.b + b.b, 1, 1e-12);
}

TEST(color, constant_emission_keeps_its_luminance) {
  const Rgb c = rgb_from_emission({{{360, 7}, {830, 7}}});
  EXPECT_NEAR(0.2126729 * c.r + 0.7151522 * c.g + 0.0721750 * c.b, 7, 1e-5);
  // Equal energy is redder than D65.
  EXPECT_NEAR(c.r / 7, 1.2048, 2e-3);
  EXPECT_NEAR(c.g / 7, 0.9483, 2e-3);
  EXPECT_NEAR(c.b / 7, 0.9089, 2e-3);
}

TEST(color, curves_are_zero_beyond_their_ends) {
  // As if their ends fell to zero within a thousandth of a nanometre.
  const SpectralCurve part{{{450, 2}, {650, 3}}};
  const SpectralCurve whole{{{360, 0}, {449.999, 0}, {450, 2}, {650, 3}, {650.001, 0}, {830, 0}}};
  const Rgb seen = rgb_from_reflectance(part), emitted = rgb_from_emission(part);
  EXPECT_EQ(seen, rgb_from_reflectance(whole));
  EXPECT_EQ(emitted, rgb_from_emission(whole));
  const SpectralCurve held{{{360, 2}, {450, 2}, {650, 3}, {830, 3}}};
  EXPECT_GT(rgb_from_emission(held).r, 1.01 * emitted.r);
}

TEST(color, becomes_a_spectrum_without_a_fourth_lane) {
  EXPECT_EQ(reflectance_spectrum(Rgb{0.1, 0.2, 0.3}), Spectrum(0.1f, 0.2f, 0.3f, 0));
  EXPECT_EQ(emission_spectrum(Rgb{10, 20, 30}), Spectrum(10, 20, 30, 0));
  const SpectralCurve curve{{{400, 0.1}, {700, 0.9}}};
  const Rgb seen = rgb_from_reflectance(curve), emitted = rgb_from_emission(curve);
  EXPECT_FLOAT_EQ(reflectance_spectrum(curve)[0], float(seen.r));
  EXPECT_FLOAT_EQ(emission_spectrum(curve)[2], float(emitted.b));
  EXPECT_EQ(emission_spectrum(curve)[3], 0);
}

}  // namespace
}  // namespace kaustik
