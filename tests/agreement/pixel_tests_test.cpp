// The test of pixels: it leaves skewed noise alone, and finds a single pixel.

#include "tests/agreement/pixel_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::agreement {
namespace {

constexpr int columns = 64;
constexpr size_t pixels = size_t(columns) * size_t(columns);

/// Light of 0.5 to 1.5 that pixels near one another share, with noise of so much of it, most of
/// which comes from rare bright samples.
Replicates noisy(uint32_t seed, double noise) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> exponential(1);
  Replicates all;
  for (int r = 0; r < replicate_total; ++r) {
    std::vector<float>& row = all.emplace_back();
    for (size_t i = 0; i < pixels; ++i) {
      const double light = 1 + 0.5 * std::sin(double(i % columns) / 9);
      const double e = exponential(random);
      row.push_back(float(light * (1 + noise * (e * e - 2) / std::sqrt(20.0))));
    }
  }
  return all;
}

PixelMoments reference_of(uint32_t seed) {
  return moments_of({{"direct", noisy(seed, 0.1)}}).at("direct");
}

TEST(PixelTests, RejectFewOfEqualExpectations) {
  int rejected = 0;
  for (uint32_t trial = 0; trial < 60; ++trial) {
    const PixelVerdict verdict =
        compare_pixels(noisy(2 * trial, 0.3), reference_of(2 * trial + 1), columns);
    EXPECT_EQ(verdict.counted, pixels);
    rejected += verdict.p_worst < pixel_level;
  }
  EXPECT_LE(rejected, 4);  // 0.6 ± 0.8 by the level
}

TEST(PixelTests, FindASinglePixel) {
  Replicates one = noisy(1, 0.3);
  const double found = compare_pixels(one, reference_of(2), columns).median_found;
  EXPECT_GT(found, 0.2);
  EXPECT_LT(found, 1.5);
  const size_t place = 1234;
  const auto light = float(1 + 0.5 * std::sin(double(place % columns) / 9));
  for (auto& row : one) row[place] += 2 * float(found) * light;
  const PixelVerdict verdict = compare_pixels(one, reference_of(2), columns);
  EXPECT_EQ(verdict.worst_pixel, int(place));
  EXPECT_LT(verdict.p_worst, pixel_level);
  // A pixel that all renders of one side leave black knows of no noise.
  for (auto& row : one) row[place] = 0;
  EXPECT_LT(compare_pixels(one, reference_of(2), columns).worst_t, 0);
}

TEST(PixelTests, DarkPixelsAreLeftOut) {
  Replicates all = noisy(1, 0.3), other = noisy(2, 0.1);
  for (size_t i = 0; i < 100; ++i) {
    for (auto& row : all) row[i] = 1e-2f;
    for (auto& row : other) row[i] = 1e-3f;
  }
  const PixelVerdict verdict =
      compare_pixels(all, moments_of({{"direct", other}}).at("direct"), columns);
  EXPECT_EQ(verdict.counted, pixels - 100);
  EXPECT_GT(verdict.p_worst, pixel_level);
}

TEST(PixelTests, FilesKeepMeansAndErrors) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("pixels.exr");
  const PixelReference written = moments_of({{"direct", noisy(1, 0.1)}, {"caustic", noisy(2, 1)}});
  write_pixels(written, path);
  const PixelReference read = read_pixels(path);
  ASSERT_EQ(read.size(), 2u);
  for (const auto& [component, moments] : written)
    for (size_t i = 0; i < pixels; ++i) {
      const PixelMoments& kept = read.at(component);
      EXPECT_NEAR(kept.mean[i], moments.mean[i], 5e-4f * moments.mean[i]);
      EXPECT_NEAR(kept.standard_error[i], moments.standard_error[i],
                  2e-3f * moments.standard_error[i]);
      // No less than what rounding does to the mean.
      EXPECT_GT(moments.standard_error[i], 2.5e-4f * moments.mean[i]);
    }
  Replicates too_bright = noisy(3, 0.1);
  for (auto& row : too_bright) row[7] = 1e5f;
  EXPECT_THROW(write_pixels(moments_of({{"direct", too_bright}}), path), Error);
  write_image(Image(4, 4, {"direct"}), path);
  EXPECT_THROW(read_pixels(path), Error);
}

}  // namespace
}  // namespace kaustik::agreement
