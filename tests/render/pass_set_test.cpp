// Sets of passes, against a plain list of flags.

#include "kaustik/render/pass_set.h"

#include <gtest/gtest.h>

#include <random>

namespace kaustik {
namespace {

constexpr uint32_t universe = 40;

PassSet random_set(std::mt19937& generator, std::vector<bool>& flags) {
  std::uniform_int_distribution<uint32_t> place(0, universe - 6), length(0, 5);
  PassSet set;
  flags.assign(universe, false);
  for (int i = 0; i < 6; ++i) {
    const uint32_t begin = place(generator), end = begin + length(generator);
    set.add(PassRange{begin, end});
    for (uint32_t pass = begin; pass < end; ++pass) flags[pass] = true;
  }
  return set;
}

TEST(PassSet, IsWhatWasAdded) {
  std::mt19937 generator(1);
  for (int i = 0; i < 200; ++i) {
    std::vector<bool> a_flags, b_flags;
    const PassSet a = random_set(generator, a_flags), b = random_set(generator, b_flags);
    PassSet both = a;
    both.add(b);
    uint32_t count = 0, common = 0;
    for (uint32_t pass = 0; pass < universe; ++pass) {
      ASSERT_EQ(a.holds(pass), a_flags[pass]);
      ASSERT_EQ(both.holds(pass), a_flags[pass] || b_flags[pass]);
      ASSERT_EQ(a.common(b).holds(pass), a_flags[pass] && b_flags[pass]);
      count += a_flags[pass] ? 1 : 0;
      common += a_flags[pass] && b_flags[pass] ? 1 : 0;
      uint32_t missing = pass;
      while (missing < universe && a_flags[missing]) ++missing;
      ASSERT_EQ(a.first_missing(pass), missing);
    }
    EXPECT_EQ(a.count(), count);
    EXPECT_EQ(a.common(b).count(), common);
    EXPECT_EQ(a.missing({0, universe}), universe - count);
    for (uint32_t r = 0; r < 3; ++r) {
      uint32_t expected = 0;
      for (uint32_t pass = r; pass < universe; pass += 3) expected += a_flags[pass] ? 1 : 0;
      EXPECT_EQ(a.count_of_remainder(r, 3), expected);
    }
    for (size_t k = 1; k < both.ranges().size(); ++k)
      EXPECT_GT(both.ranges()[k].begin, both.ranges()[k - 1].end);
  }
}

TEST(PassSet, SaysWhatItHolds) {
  PassSet set;
  EXPECT_EQ(set.text(), "none");
  set.add(PassRange{7, 8});
  set.add(PassRange{0, 4});
  EXPECT_EQ(set.text(), "0–3, 7");
  set.add(PassRange{4, 7});
  EXPECT_EQ(set.text(), "0–7");
}

/// Sets of many ranges are put together in time that grows with their number: with its square, this
/// would take hours, and ctest would end it.
TEST(PassSet, ManyRanges) {
  constexpr uint32_t count = 2'000'000;
  PassSet even, odd;
  for (uint32_t i = 0; i < count; ++i) {
    even.add(PassRange{4 * i, 4 * i + 1});
    odd.add(PassRange{4 * i + 2, 4 * i + 3});
  }
  even.add(odd);
  EXPECT_EQ(even.count(), 2 * count);
  EXPECT_EQ(even.ranges().size(), 2 * count);
}

}  // namespace
}  // namespace kaustik
