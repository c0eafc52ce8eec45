// What is rounded before it is summed: multiples of one power of two, as near as can be.

#include "kaustik/render/rounded_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kaustik {
namespace {

constexpr size_t tile_pixels = PictureTiles::pixels;
constexpr int bits = 20;

template <typename Number>
std::array<Number, tile_pixels> made_up(double least, double most) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> power(least, most);
  std::array<Number, tile_pixels> values;
  for (size_t i = 0; i < tile_pixels; ++i)
    values[i] = i % 7 == 0 ? Number(0) : Number((i % 5 == 0 ? -1 : 1) * std::exp2(power(random)));
  return values;
}

template <typename Number>
double geometric_mean(const std::array<Number, tile_pixels>& values) {
  double sum = 0, count = 0;
  for (const Number value : values)
    if (value != 0) sum += std::floor(std::log2(std::abs(double(value)))), ++count;
  return std::exp2(std::floor(sum / count));
}

template <typename Number>
void expect_rounded(const std::array<Number, tile_pixels>& values) {
  auto rounded = values;
  round_line(rounded, bits);
  const double unit = std::ldexp(geometric_mean(values), -bits);
  double worst = 0;
  for (size_t i = 0; i < tile_pixels; ++i) {
    const double off = std::abs(double(rounded[i]) - double(values[i]));
    worst = std::max(worst, off / unit);
    EXPECT_EQ(std::remainder(double(rounded[i]), unit), 0) << i;
    EXPECT_TRUE(values[i] != 0 || rounded[i] == 0);
  }
  EXPECT_LE(worst, 0.5);
  // It does round.
  EXPECT_GT(worst, 0.2);
  // What is rounded stays.
  auto again = rounded;
  round_line(again, bits);
  EXPECT_EQ(again, rounded);
}

TEST(RoundedLine, IsMadeOfMultiples) {
  expect_rounded(made_up<float>(-9, 6));
  expect_rounded(made_up<double>(-9, 6));
  expect_rounded(made_up<double>(-80, -60));
  expect_rounded(made_up<double>(90, 110));
}

TEST(RoundedLine, ZerosAndOneValueStay) {
  std::array<float, tile_pixels> values{};
  round_line(values, bits);
  EXPECT_EQ(values, (std::array<float, tile_pixels>{}));
  values[9] = 0.7f;
  const auto before = values;
  round_line(values, 24);
  EXPECT_EQ(values, before);
}

/// A lamp, or the sun, in half of the tile takes only few bits of the other half.
TEST(RoundedLine, BrightPixelsLeaveDarkOnesTheirBits) {
  std::array<float, tile_pixels> values;
  for (size_t i = 0; i < tile_pixels; ++i) values[i] = i < tile_pixels / 2 ? 0.3f : 0.3e6f;
  auto rounded = values;
  round_line(rounded, 24);
  for (size_t i = 0; i < tile_pixels; ++i)
    EXPECT_NEAR(rounded[i], values[i], std::ldexp(values[i], -14)) << i;
}

/// Beyond what doubles have as multiples nothing goes wrong.
TEST(RoundedLine, GiantsKeepTheirBits) {
  std::array<double, tile_pixels> values;
  values.fill(1.1);
  values[3] = 1.1e60;
  values[4] = -3e30;
  auto rounded = values;
  round_line(rounded, 32);
  for (const size_t i : {3u, 4u}) EXPECT_NEAR(rounded[i] / values[i], 1, 0x1p-50);
  EXPECT_NEAR(rounded[5], 1.1, 1e-9);
}

}  // namespace
}  // namespace kaustik
