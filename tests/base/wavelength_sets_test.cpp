#include "kaustik/base/wavelength_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "kaustik/base/color.h"

namespace kaustik {
namespace {

/// What the sets of a pass show of light, whose mean over them is asked for.
template <typename Light>
Spectrum seen(const WavelengthSets& sets, const Light& light) {
  Spectrum sum;
  for (size_t i = 0; i < sets.count(); ++i)
    sum += rgb_from_lanes(light(sets[i]), sets[i]) * sets.balance() / float(sets.count());
  return sum;
}

std::vector<double> quantiles(const WavelengthSets& sets) {
  std::vector<double> result;
  const auto scale = [](double x) { return std::tanh(0.0072 * (x - 538)); };
  for (size_t i = 0; i < sets.count(); ++i)
    for (int lane = 0; lane < 4; ++lane)
      result.push_back((scale(double(sets[i][lane])) - scale(360)) / (scale(830) - scale(360)));
  std::sort(result.begin(), result.end());
  return result;
}

TEST(wavelength_sets, rgb_is_one_set) {
  const WavelengthSets rgb;
  EXPECT_TRUE(rgb.is_rgb());
  EXPECT_EQ(rgb.count(), 1u);
  EXPECT_EQ(rgb.balance(), Spectrum(1));
  for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(rgb.of_sample(3, i), 0u);
}

TEST(wavelength_sets, sixteen_quantiles_of_a_pass_are_equidistant) {
  for (const uint32_t pass : {0u, 1u, 5u, 1000u, (1u << 31) + 3u}) {
    const std::vector<double> at = quantiles(WavelengthSets::of_pass(7, pass));
    ASSERT_EQ(at.size(), 16u);
    for (size_t i = 1; i < 16; ++i) EXPECT_NEAR(at[i] - at[i - 1], 1.0 / 16, 1e-5);
  }
}

TEST(wavelength_sets, sixteen_passes_have_256_equidistant_quantiles) {
  std::vector<double> all;
  for (uint32_t pass = 0; pass < 16; ++pass)
    for (const double q : quantiles(WavelengthSets::of_pass(3, pass))) all.push_back(q);
  std::sort(all.begin(), all.end());
  for (size_t i = 1; i < all.size(); ++i) EXPECT_NEAR(all[i] - all[i - 1], 1.0 / 256, 1e-5);
}

TEST(wavelength_sets, two_samples_in_succession_have_eight_equidistant_quantiles) {
  const WavelengthSets sets = WavelengthSets::of_pass(1, 0);
  for (const uint32_t first : {0u, 2u, 6u}) {
    std::vector<float> nm;
    for (const uint32_t i : {0u, 1u})
      for (int lane = 0; lane < 4; ++lane) nm.push_back(sets[sets.of_sample(first, i)][lane]);
    std::vector<double> at;
    const auto scale = [](double x) { return std::tanh(0.0072 * (x - 538)); };
    for (const float x : nm)
      at.push_back((scale(double(x)) - scale(360)) / (scale(830) - scale(360)));
    std::sort(at.begin(), at.end());
    for (size_t i = 1; i < 8; ++i) EXPECT_NEAR(at[i] - at[i - 1], 1.0 / 8, 1e-5);
  }
}

TEST(wavelength_sets, white_light_is_white_in_every_pass) {
  for (uint32_t pass = 0; pass < 40; ++pass) {
    const Spectrum white = seen(WavelengthSets::of_pass(11, pass),
                                [](const Wavelengths& w) { return white_light(w); });
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(white[i], 1, 1e-5) << pass;
  }
}

TEST(wavelength_sets, colours_are_near_from_the_first_pass_on) {
  // The worst of the passes; single sets are wrong by half.
  const Spectrum rgb(0.6f, 0.1f, 0.05f, 0);
  double worst = 0, worst_of_one = 0;
  for (uint32_t pass = 0; pass < 40; ++pass) {
    const WavelengthSets sets = WavelengthSets::of_pass(11, pass);
    const auto light = [&](const Wavelengths& w) { return lanes_from_emission(rgb, w); };
    const Spectrum found = seen(sets, light), of_one = seen(WavelengthSets(sets[0]), light);
    for (int i = 0; i < 3; ++i) {
      worst = std::max(worst, std::fabs(double(found[i] - rgb[i])));
      worst_of_one = std::max(worst_of_one, std::fabs(double(of_one[i] - rgb[i])));
    }
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst_of_one, 0.05);
}

TEST(wavelength_sets, what_was_given_is_the_same_in_every_pass) {
  const WavelengthSets given(Wavelengths(440, 500, 580, 660));
  EXPECT_TRUE(given.of_other_pass(1, 7) == given);
  EXPECT_TRUE(WavelengthSets().of_other_pass(1, 7).is_rgb());
  EXPECT_TRUE(WavelengthSets::of_pass(1, 0, 3).of_other_pass(1, 7) ==
              WavelengthSets::of_pass(1, 7, 3));
}

TEST(wavelength_sets, seeds_and_passes_differ) {
  EXPECT_FALSE(WavelengthSets::of_pass(1, 0) == WavelengthSets::of_pass(2, 0));
  EXPECT_FALSE(WavelengthSets::of_pass(1, 0) == WavelengthSets::of_pass(1, 1));
  EXPECT_TRUE(WavelengthSets::of_pass(1, 4) == WavelengthSets::of_pass(1, 4));
}

}  // namespace
}  // namespace kaustik
