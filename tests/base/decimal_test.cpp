#include "kaustik/base/decimal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace kaustik::test {
namespace {

/// To the bit, as far as it takes them at all.
TEST(Decimal, IsWhatFromCharsGives) {
  std::mt19937_64 random(3);
  int taken = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::string text = random() % 3 == 0 ? "-" : "";
    const int before = 1 + int(random() % 10), behind = int(random() % 10);
    for (int digit = 0; digit < before; ++digit) text += char('0' + random() % 10);
    if (behind > 0) text += ".";
    for (int digit = 0; digit < behind; ++digit) text += char('0' + random() % 10);
    double expected = 0, value = 0;
    std::from_chars(text.data(), text.data() + text.size(), expected);
    // What follows, and whether there is much of it, changes nothing.
    constexpr std::string_view tails[] = {"",    " ",         " 123456789",
                                          "/12", ":::::::::", "\xff\xff\xff"};
    const std::string_view tail = tails[random() % std::size(tails)];
    text += tail;
    std::string_view rest = text;
    if (!take_decimal(rest, value)) {
      EXPECT_EQ(rest, text);
      EXPECT_GE(std::max(before, behind), 8) << text;
      continue;
    }
    ++taken;
    EXPECT_EQ(rest, tail) << text;
    EXPECT_EQ(std::bit_cast<uint64_t>(value), std::bit_cast<uint64_t>(expected)) << text;
  }
  EXPECT_GT(taken, 100'000);
}

TEST(Decimal, LeavesTheRest) {
  const auto left = [](std::string_view text) {
    double value = 0;
    return take_decimal(text, value) ? std::string(text) : "not taken: " + std::string(text);
  };
  EXPECT_EQ(left("1.5 2"), " 2");
  EXPECT_EQ(left("12/3"), "/3");
  EXPECT_EQ(left("0x10"), "x10");
  for (const std::string other : {"", "-", ".5", "5.", "+1", " 1", "1e5", "1.5E-3", "nan", "inf",
                                  "-.5", "12345678", "0.12345678"})
    EXPECT_EQ(left(other), "not taken: " + other);
  double zero = 1;
  std::string_view minus_zero = "-0.0";
  EXPECT_TRUE(take_decimal(minus_zero, zero));
  EXPECT_TRUE(std::signbit(zero));
}

}  // namespace
}  // namespace kaustik::test
