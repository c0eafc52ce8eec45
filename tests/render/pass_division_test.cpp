// Passes in parts: none twice, none left out, and the missing ones have names.

#include "kaustik/render/pass_division.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kaustik {
namespace {

TEST(PassDivisions, PartsAreAllOfItAndDoNotOverlap) {
  for (const uint32_t passes : {1u, 2u, 7u, 64u, 1000u})
    for (const uint32_t parts : {1u, 2u, 3u, 64u, 999u}) {
      if (parts > passes) continue;
      const PassDivision division{{5, 5 + passes}, parts};
      uint32_t next = 5, least = passes, most = 0;
      for (uint32_t i = 0; i < parts; ++i) {
        const PassRange part = division.part(i);
        EXPECT_EQ(part.begin, next);
        next = part.end;
        least = std::min(least, part.end - part.begin);
        most = std::max(most, part.end - part.begin);
      }
      EXPECT_EQ(next, 5 + passes);
      EXPECT_GE(least, 1u);
      EXPECT_LE(most - least, 1u);
    }
}

TEST(PassDivisions, LargeNumbersDoNotOverflow) {
  const PassDivision division{{0, pass_limit}, PassPart::maximum_count};
  EXPECT_EQ(division.part(PassPart::maximum_count - 1).end, pass_limit);
  EXPECT_EQ(division.part(500'000).begin, pass_limit / 2);
}

TEST(PassDivisions, MissingPartsAreNamed) {
  const PassDivision division{{0, 20}, 10};
  PassSet there;
  EXPECT_EQ(missing_parts(division, there).text(10), "parts 1–10 of 10 are missing");
  there.add({0, 4});
  there.add({6, 7});
  there.add({8, 18});
  const MissingParts missing = missing_parts(division, there);
  EXPECT_EQ(missing.absent, (std::vector<uint32_t>{3, 10}));
  EXPECT_EQ(missing.unfinished, (std::vector<uint32_t>{4}));
  EXPECT_EQ(missing.text(10), "parts 3, 10 of 10 are missing; part 4 of 10 is unfinished");
  there.add({0, 20});
  EXPECT_TRUE(missing_parts(division, there).empty());
  EXPECT_EQ(missing_parts(division, there).text(10), "");
  // What is not divided lacks nothing.
  EXPECT_TRUE(missing_parts({}, {}).empty());
}

}  // namespace
}  // namespace kaustik
