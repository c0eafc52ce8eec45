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
  EXPECT_EQ(TeamPace(3).shares(100, 60, 1e9), (Shares{1, 1, 1}));
  EXPECT_EQ(TeamPace(3).shares(2, 60, 1e9), (Shares{1, 1, 0}));
  EXPECT_EQ(TeamPace(3).usual_pass_s(), 0);
}

TEST(TeamPace, WhoIsTwiceAsFastGetsTwiceAsMany) {
  TeamPace pace(3);
  pace.add(0, 2, 2);
  pace.add(1, 1, 2);
  pace.add(2, 4, 4);
  EXPECT_EQ(pace.shares(100, 4, 1e9), (Shares{4, 2, 4}));
  EXPECT_EQ(pace.shares(5, 4, 1e9), (Shares{2, 1, 2}));
  EXPECT_EQ(pace.usual_pass_s(), 1);
  EXPECT_EQ(pace.fastest_pass_s(), 1);
}

TEST(TeamPace, NoiseOfTheClockChangesNothing) {
  TeamPace pace(4);
  for (const uint32_t rank : {0, 1, 2, 3}) pace.add(rank, 8, 8 * (1 + 0.02 * rank));
  EXPECT_EQ(pace.shares(1000, 8, 1e9), (Shares{8, 8, 8, 8}));
}

/// Rounds of ten seconds: one pass of the slow one costs the other nine times that.
TEST(TeamPace, WhoIsTooSlowIsTriedAgain) {
  TeamPace pace(2);
  int tries = 0;
  double waited_s = 0, all_s = 0;
  for (int round = 0; round < 1000; ++round) {
    const Shares shares = pace.shares(100, 10, 1e9);
    const double round_s = std::max(1.0 * shares[0], 100.0 * shares[1]);
    pace.add(0, shares[0], shares[0]);
    pace.add(1, shares[1], 100.0 * shares[1]);
    pace.round_done(round_s);
    if (round == 0) continue;
    tries += int(shares[1]);
    all_s += round_s;
    waited_s += round_s - shares[0];
  }
  EXPECT_GT(tries, 3);
  EXPECT_LT(waited_s, 0.06 * all_s);
}

TEST(TeamPace, WhoIsFastAgainGetsItsShare) {
  TeamPace pace(2);
  pace.add(0, 10, 10);
  pace.add(1, 1, 100);
  pace.round_done(100);
  for (int round = 0; round < 1000 && pace.shares(100, 10, 1e9)[1] == 0; ++round) {
    pace.add(0, 10, 10);
    pace.round_done(10);
  }
  for (int round = 0; round < 8; ++round) {
    const Shares shares = pace.shares(100, 10, 1e9);
    for (const uint32_t rank : {0, 1}) pace.add(rank, shares[rank], shares[rank]);
    pace.round_done(10);
  }
  EXPECT_EQ(pace.shares(100, 10, 1e9), (Shares{10, 10}));
}

TEST(TeamPace, NobodyIsTriedWithoutTime) {
  TeamPace pace(2);
  pace.add(0, 10, 10);
  pace.add(1, 1, 100);
  for (int round = 0; round < 1000; ++round) {
    pace.round_done(10);
    EXPECT_EQ(pace.shares(100, 10, 99), (Shares{10, 0}));
    pace.add(0, 10, 10);
  }
  EXPECT_EQ(pace.shares(100, 10, 101), (Shares{10, 1}));
  EXPECT_EQ(pace.shares(10, 10, 101), (Shares{9, 1}));
}

/// Passes that all take longer than a round keep their times.
TEST(TeamPace, TimesStayThoseMeasured) {
  TeamPace pace(2);
  for (int round = 0; round < 20; ++round) {
    for (const uint32_t rank : {0, 1}) pace.add(rank, 1, 100);
    pace.round_done(100);
    EXPECT_EQ(pace.shares(100, 10, 1e9), (Shares{1, 0}));
    EXPECT_EQ(pace.fastest_pass_s(), 100);
  }
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
  EXPECT_EQ(pace.shares(100, 0, 1e9), (Shares{0, 1}));
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
    const Shares shares = pace.shares(most, 1e6, 1e9);
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
