// How many passes each member of a team gets.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "kaustik/render/team_pace.h"

namespace kaustik {
namespace {

using Shares = std::vector<uint32_t>;

TEST(TeamPace, OneEachWhileNobodyIsKnown) {
  EXPECT_EQ(TeamPace(3).shares(100, 60), (Shares{1, 1, 1}));
  EXPECT_EQ(TeamPace(3).shares(2, 60), (Shares{1, 1, 0}));
  EXPECT_EQ(TeamPace(3).usual_pass_s(), 0);
}

TEST(TeamPace, WhoIsTwiceAsFastGetsTwiceAsMany) {
  TeamPace pace(3);
  pace.add(0, 2, 2);
  pace.add(1, 1, 2);
  pace.add(2, 4, 4);
  EXPECT_EQ(pace.shares(100, 4), (Shares{4, 2, 4}));
  EXPECT_EQ(pace.shares(5, 4), (Shares{2, 1, 2}));
  EXPECT_EQ(pace.usual_pass_s(), 1);
  EXPECT_EQ(pace.fastest_pass_s(), 1);
}

TEST(TeamPace, NoiseOfTheClockChangesNothing) {
  TeamPace pace(4);
  for (const uint32_t rank : {0, 1, 2, 3}) pace.add(rank, 8, 8 * (1 + 0.02 * rank));
  EXPECT_EQ(pace.shares(1000, 8), (Shares{8, 8, 8, 8}));
}

TEST(TeamPace, WhoIsTooSlowIsTriedAgain) {
  TeamPace pace(2);
  pace.add(0, 10, 10);
  pace.add(1, 1, 100);
  EXPECT_EQ(pace.shares(100, 10), (Shares{10, 0}));
  for (int round = 0; round < 10 && pace.shares(100, 10)[1] == 0; ++round) pace.doubt(10);
  EXPECT_GT(pace.shares(100, 10)[1], 0u);
}

TEST(TeamPace, NobodyIsDoubtedForLackOfWork) {
  TeamPace pace(2);
  pace.add(0, 10, 10);
  pace.add(1, 5, 10);
  pace.doubt(10);
  EXPECT_EQ(pace.shares(100, 10), (Shares{10, 5}));
}

TEST(TeamPace, RoundsGrow) {
  TeamPace pace(3);
  EXPECT_EQ(pace.next_round_s(5, 300), 5);
  for (const uint32_t rank : {0, 1, 2}) pace.add(rank, 10, 20);
  const double next_s = pace.next_round_s(5, 300);
  EXPECT_EQ(next_s, 30);
  for (const uint32_t rank : {0, 1, 2}) pace.add(rank, 15, next_s);
  EXPECT_GT(pace.next_round_s(5, 300), next_s);
  EXPECT_EQ(pace.next_round_s(5, 40), 40);
}

TEST(TeamPace, ThereIsAlwaysWork) {
  TeamPace pace(2);
  pace.add(0, 1, 100);
  pace.add(1, 1, 90);
  EXPECT_EQ(pace.shares(100, 0), (Shares{0, 1}));
}

/// No other shares of as many passes end sooner than by what one pass of somebody takes.
TEST(TeamPace, AllAreDoneAtAboutTheSameTime) {
  std::mt19937 generator(5);
  std::lognormal_distribution<double> pass_s(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto members = 1 + uint32_t(generator() % 40);
    std::vector<double> each(members);
    TeamPace pace(members);
    for (uint32_t rank = 0; rank < members; ++rank)
      pace.add(rank, 1, each[rank] = pass_s(generator));
    const uint64_t most = 1 + generator() % 1000;
    const Shares shares = pace.shares(most, 1e6);
    ASSERT_EQ(std::accumulate(shares.begin(), shares.end(), uint64_t{0}), most);
    double longest_s = 0, speed = 0;
    for (uint32_t rank = 0; rank < members; ++rank) {
      longest_s = std::max(longest_s, shares[rank] * each[rank]);
      speed += 1 / each[rank];
    }
    const double slowest_s = *std::ranges::max_element(each);
    EXPECT_LE(longest_s, double(most) / speed + slowest_s) << trial;
  }
}

}  // namespace
}  // namespace kaustik
