#include "kaustik/base/wavelengths.h"

#include <gtest/gtest.h>

#include "kaustik/base/color.h"

namespace kaustik {
namespace {

/// The colour of light that all visible wavelengths bring.
template <typename Light>
Rgb seen(const Light& light) {
  constexpr int sets = 1880;
  Rgb sum;
  for (int i = 0; i < sets; ++i) {
    const Wavelengths w = Wavelengths::spaced((float(i) + 0.5f) / float(sets));
    const Spectrum c = rgb_from_lanes(light(w), w);
    sum.r += double(c[0]), sum.g += double(c[1]), sum.b += double(c[2]);
    EXPECT_EQ(c[3], 0);
  }
  return {sum.r / sets, sum.g / sets, sum.b / sets};
}

void expect_near(const Rgb& found, const Rgb& expected, double tolerance) {
  EXPECT_NEAR(found.r, expected.r, tolerance);
  EXPECT_NEAR(found.g, expected.g, tolerance);
  EXPECT_NEAR(found.b, expected.b, tolerance);
}

TEST(wavelengths, rgb_is_the_identity) {
  const Wavelengths rgb;
  EXPECT_TRUE(rgb.is_rgb());
  EXPECT_EQ(rgb.alive_count(), 4);
  const Spectrum lanes(0.1f, -0.0f, 3e30f, 0);
  for (const Spectrum& same : {rgb_from_lanes(lanes, rgb), lanes_from_reflectance(lanes, rgb),
                               lanes_from_emission(lanes, rgb)})
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(same[i], lanes[i]);
      EXPECT_EQ(std::signbit(same[i]), std::signbit(lanes[i]));
    }
  EXPECT_EQ(white_light(rgb), Spectrum(1, 1, 1, 0));
}

/// ∫ from 360 nm on of the density that Wavelengths::spaced() promises.
double quantile_of(double nm) {
  const auto scale = [](double x) { return std::tanh(0.0072 * (x - 538)); };
  return (scale(nm) - scale(360)) / (scale(830) - scale(360));
}

TEST(wavelengths, quantiles_of_spaced_lanes_are_a_quarter_apart) {
  const Wavelengths w = Wavelengths::spaced(0.9f);
  EXPECT_FALSE(w.is_rgb());
  for (int lane = 0; lane < 4; ++lane)
    EXPECT_NEAR(quantile_of(double(w[lane])), std::fmod(0.9 + 0.25 * lane, 1), 1e-5);
  for (const float u : {0.0f, 0.25f, 0.5f, 0.75f, 0.99999994f})
    for (int lane = 0; lane < 4; ++lane) {
      EXPECT_GE(Wavelengths::spaced(u)[lane], 360);
      EXPECT_LE(Wavelengths::spaced(u)[lane], 830);
    }
}

TEST(wavelengths, one_lane_goes_on_where_lanes_part) {
  const Wavelengths all(450, 500, 550, 600), one = all.only(2);
  EXPECT_EQ(all.alive_count(), 4);
  EXPECT_EQ(one.alive_count(), 1);
  EXPECT_TRUE(one.is_alive(2));
  EXPECT_FALSE(one.is_alive(0));
  EXPECT_FALSE(one.is_rgb());
  for (int lane = 0; lane < 4; ++lane) EXPECT_EQ(one[lane], all[lane]);
  EXPECT_EQ(one.only(2), one);
  EXPECT_FALSE(one == all);
}

TEST(wavelengths, uplifted_colours_are_seen_as_they_are) {
  for (const Spectrum& c :
       {Spectrum(1, 1, 1, 0), Spectrum(1, 0, 0, 0), Spectrum(0, 1, 0, 0), Spectrum(0, 0, 1, 0),
        Spectrum(0.2f, 0.7f, 0.05f, 0), Spectrum(13, 2, 0.5f, 0)}) {
    const Rgb found = seen([&](const Wavelengths& w) { return lanes_from_emission(c, w); });
    expect_near(found, {double(c[0]), double(c[1]), double(c[2])}, 1e-4 * double(c.max_lane()));
  }
}

TEST(wavelengths, a_colour_that_is_taken_for_another_would_be_found) {
  const Rgb found = seen([&](const Wavelengths& w) {
    return lanes_from_emission(Spectrum(0.2f, 0.7003f, 0.05f, 0), w);
  });
  EXPECT_GT(std::fabs(found.g - 0.7), 1e-4 * 0.7);
}

TEST(wavelengths, uplifted_reflectances_have_their_colour_and_keep_their_range) {
  for (const Rgb& c : {Rgb{0.9, 0.1, 0.3}, Rgb{0, 1, 0}, Rgb{1, 0, 1}, Rgb{0.5, 0.5, 0.5}}) {
    const Spectrum rgb = spectrum_from_rgb(float(c.r), float(c.g), float(c.b));
    SpectralCurve curve;
    for (int nm = 360; nm <= 830; ++nm) {
      const auto x = float(nm);
      const float value = lanes_from_reflectance(rgb, {x, x, x, x})[0];
      EXPECT_GE(value, std::min({c.r, c.g, c.b}) - 1e-6);
      EXPECT_LE(value, std::max({c.r, c.g, c.b}) + 1e-6);
      curve.samples.emplace_back(nm, value);
    }
    expect_near(rgb_from_reflectance(curve), c, 1e-6);
  }
}

TEST(wavelengths, light_of_a_curve_is_seen_as_its_rgb) {
  const SpectralCurve curve{{{360, 0.1}, {480, 2}, {600, 1}, {830, 3}}};
  const auto value = [](double nm) {
    return nm < 480   ? 0.1 + 1.9 * (nm - 360) / 120
           : nm < 600 ? 2 - (nm - 480) / 120
                      : 1 + 2 * (nm - 600) / 230;
  };
  const Rgb found = seen([&](const Wavelengths& w) {
    Spectrum lanes;
    for (int i = 0; i < 4; ++i) lanes.set(i, float(value(double(w[i]))));
    return lanes;
  });
  // Of films white is white; the matrix of rgb_from_emission() has it up to 2e-4.
  expect_near(found, rgb_from_emission(curve), 3e-4);
}

}  // namespace
}  // namespace kaustik
