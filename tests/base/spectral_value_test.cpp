#include "kaustik/base/spectral_value.h"

#include <gtest/gtest.h>

#include "kaustik/base/color.h"

namespace kaustik {
namespace {

const Wavelengths four(420, 500.5f, 600, 755);

TEST(spectral_value, constants_and_zero) {
  EXPECT_EQ(SpectralValue().at(four), Spectrum());
  EXPECT_EQ(SpectralValue().at({}), Spectrum());
  const SpectralValue c(0.3f);
  EXPECT_TRUE(c.is_constant());
  EXPECT_EQ(c.at(four), Spectrum(0.3f));
  EXPECT_EQ(c.at({}), Spectrum(0.3f));
}

TEST(spectral_value, rgb_mode_gives_the_lanes_that_were_computed_once) {
  const SpectralCurve curve{{{400, 0.1}, {500, 0.9}, {700, 0.2}}};
  EXPECT_EQ(SpectralValue::reflectance(curve).at({}), reflectance_spectrum(curve));
  EXPECT_EQ(SpectralValue::emission(curve).at({}), emission_spectrum(curve));
  const Rgb c{0.1, 0.2, 0.3};
  EXPECT_EQ(SpectralValue::reflectance(c).at({}), Spectrum(0.1f, 0.2f, 0.3f, 0));
  EXPECT_EQ(SpectralValue::emission(c).at({}), Spectrum(0.1f, 0.2f, 0.3f, 0));
  EXPECT_EQ(SpectralValue::reflectance(c).rgb(), SpectralValue::reflectance(c).at({}));
}

TEST(spectral_value, light_and_reflectances_are_zero_beyond_the_ends_of_their_curves) {
  const SpectralCurve curve{{{450, 1}, {650, 3}}};
  for (const SpectralValue& ramp :
       {SpectralValue::reflectance(curve), SpectralValue::emission(curve)}) {
    const Spectrum lanes = ramp.at(four);
    EXPECT_EQ(lanes[0], 0);
    EXPECT_FLOAT_EQ(lanes[1], 1.505f);
    EXPECT_FLOAT_EQ(lanes[2], 2.5f);
    EXPECT_EQ(lanes[3], 0);
  }
}

TEST(spectral_value, constants_of_matter_stay_beyond_the_ends) {
  const SpectralCurve curve{{{450, 1}, {650, 3}}};
  const SpectralValue ramp = SpectralValue::material_constant(curve);
  EXPECT_EQ(
      ramp.rgb(),
      SpectralValue::reflectance(SpectralCurve{{{360, 1}, {450, 1}, {650, 3}, {830, 3}}}).rgb());
  // What is no curve is the same as of something that reflects.
  EXPECT_EQ(SpectralValue::material_constant(Rgb{0.2, 0.5, 0.7}).at(four),
            SpectralValue::reflectance(Rgb{0.2, 0.5, 0.7}).at(four));
  EXPECT_FALSE(ramp.is_constant());
  const Spectrum lanes = ramp.at(four);
  EXPECT_FLOAT_EQ(lanes[0], 1);
  EXPECT_FLOAT_EQ(lanes[1], 1.505f);
  EXPECT_FLOAT_EQ(lanes[2], 2.5f);
  EXPECT_FLOAT_EQ(lanes[3], 3);
}

TEST(spectral_value, colours_are_uplifted) {
  const Spectrum c(0.2f, 0.5f, 0.7f, 0);
  EXPECT_EQ(SpectralValue::reflectance(Rgb{0.2, 0.5, 0.7}).at(four),
            lanes_from_reflectance(c, four));
  EXPECT_EQ(SpectralValue::emission(Rgb{0.2, 0.5, 0.7}).at(four), lanes_from_emission(c, four));
  // A grey reflects all wavelengths alike; grey light is D65.
  EXPECT_EQ(SpectralValue::reflectance(Rgb{0.4, 0.4, 0.4}).at(four), Spectrum(0.4f));
  const Spectrum grey = SpectralValue::emission(Rgb{1, 1, 1}).at(four);
  EXPECT_NEAR(double(grey[2] / grey[0]), d65_at(600) / d65_at(420), 1e-4);
}

TEST(spectral_value, black_bodies) {
  // Planck's law at 5000 K and 600 nm, with hc/(λkT) = 4.795923.
  EXPECT_NEAR(blackbody(5000)->at(600), 12762.389, 1e-2);
  // Wien: the peak lies at 2.897772e-3 m·K / T.
  const double peak = 2.897772e6 / 5000;
  EXPECT_GT(blackbody(5000)->at(peak), blackbody(5000)->at(peak - 2));
  EXPECT_GT(blackbody(5000)->at(peak), blackbody(5000)->at(peak + 2));
  // Stefan and Boltzmann: π times the integral over all wavelengths is σT⁴.
  double sum = 0;
  for (double nm = 100; nm < 100000; nm += 5) sum += blackbody(5000)->at(nm) * 5;
  EXPECT_NEAR(sum * std::numbers::pi / (5.670374419e-8 * std::pow(5000.0, 4)), 1, 1e-3);
  const SpectralValue value = SpectralValue::emission(blackbody(5000));
  EXPECT_FLOAT_EQ(value.at(four)[2], float(blackbody(5000)->at(600)));
  EXPECT_GT(value.rgb()[0], value.rgb()[2]);  // reddish
}

TEST(spectral_value, sums_and_products_go_lane_by_lane) {
  const SpectralValue ramp = SpectralValue::reflectance(SpectralCurve{{{400, 0}, {800, 4}}});
  const SpectralValue two(2.0f);
  EXPECT_FLOAT_EQ((ramp * two).at(four)[2], 4);
  EXPECT_FLOAT_EQ((ramp + two).at(four)[2], 4);
  EXPECT_FLOAT_EQ((ramp * ramp).at(four)[0], 0.04f);
  EXPECT_FLOAT_EQ((ramp * 3.0f).at(four)[2], 6);
  EXPECT_EQ((ramp * two).rgb(), ramp.rgb() * two.rgb());
  EXPECT_EQ((ramp + two).rgb(), ramp.rgb() + two.rgb());
  EXPECT_TRUE((two * two + two).is_constant());
  EXPECT_EQ((two * two + two).at(four), Spectrum(6));
  EXPECT_EQ(ramp.with_rgb(Spectrum(7)).rgb(), Spectrum(7));
  EXPECT_EQ(ramp.with_rgb(Spectrum(7)).at(four), ramp.at(four));
}

}  // namespace
}  // namespace kaustik
