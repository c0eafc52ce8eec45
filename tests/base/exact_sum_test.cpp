#include "kaustik/base/exact_sum.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>
#include <vector>

namespace kaustik {
namespace {

/// Numbers of both signs over 24 orders of magnitude: floats would lose most of them.
std::vector<double> numbers(size_t count) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> exponent(-12, 12), sign(-1, 1);
  std::vector<double> values;
  for (size_t i = 0; i < count; ++i)
    values.push_back(std::copysign(std::pow(10, exponent(generator)), sign(generator)));
  return values;
}

Fixed sum_of(const std::vector<double>& values) {
  Fixed sum = 0;
  for (const double value : values) sum += fixed_from(value);
  return sum;
}

TEST(ExactSum, KeepsNumbers) {
  for (const double value : {0.0, 1.0, -1.0, 0.5, -0.75, 3 * 0x1p-62, -5 * 0x1p-62,
                             123456789.015625, 1e15, -1e15, 0x1p-64, -0x1p-64})
    EXPECT_EQ(double_from(fixed_from(value)), value) << value;
  for (const double value : numbers(10000))
    EXPECT_NEAR(double_from(fixed_from(value)), value, 0x1p-63 + 1e-15 * std::fabs(value));
}

TEST(ExactSum, RoundsWhatIsTooSmallDown) {
  EXPECT_EQ(double_from(fixed_from(0x1p-65)), 0);
  EXPECT_EQ(double_from(fixed_from(1e-300)), 0);
}

TEST(ExactSum, CutsWhatIsTooLarge) {
  EXPECT_EQ(double_from(fixed_from(1e30)), fixed_maximum);
  EXPECT_EQ(double_from(fixed_from(-1e30)), -fixed_maximum);
}

TEST(ExactSum, OrderMakesNoDifference) {
  std::vector<double> values = numbers(10000);
  const Fixed sum = sum_of(values);
  double plain = 0;
  for (const double value : values) plain += value;
  std::mt19937 generator(4);
  bool plain_differs = false;
  for (int i = 0; i < 10; ++i) {
    std::shuffle(values.begin(), values.end(), generator);
    EXPECT_TRUE(sum_of(values) == sum);
    double other = 0;
    for (const double value : values) other += value;
    plain_differs = plain_differs || other != plain;
  }
  EXPECT_TRUE(plain_differs) << "the numbers are too tame for this test";
}

TEST(ExactSum, GroupingMakesNoDifference) {
  const std::vector<double> values = numbers(999);
  Fixed groups = 0;
  for (size_t begin = 0; begin < values.size(); begin += 37)
    groups += sum_of({values.begin() + std::ptrdiff_t(begin),
                      values.begin() + std::ptrdiff_t(std::min(begin + 37, values.size()))});
  EXPECT_TRUE(groups == sum_of(values));
}

TEST(ExactSum, CancelsCompletely) {
  Fixed sum = 0;
  const std::vector<double> values = numbers(1000);
  for (const double value : values) sum += fixed_from(value);
  for (const double value : values) sum -= fixed_from(value);
  EXPECT_TRUE(sum == 0);
}

TEST(ExactSum, StaysAtTheEndOfItsRange) {
  Fixed up = 0, down = 0;
  for (int i = 0; i < 3; ++i) {
    add_to(up, fixed_from(6e18));
    add_to(down, fixed_from(-6e18));
  }
  EXPECT_EQ(double_from(up), fixed_maximum);
  EXPECT_EQ(double_from(down), -fixed_maximum);
  // There too what comes last makes no difference.
  add_to(up, fixed_from(1e16));
  add_to(down, fixed_from(-1e16));
  EXPECT_EQ(double_from(up), fixed_maximum);
  EXPECT_EQ(double_from(down), -fixed_maximum);
  Fixed small = fixed_from(1.5);
  add_to(small, fixed_from(-4));
  EXPECT_EQ(double_from(small), -2.5);
}

}  // namespace
}  // namespace kaustik
