// The test of the tests: noise that is wide, skewed and shared by blocks is not taken for a bias, a
// bias is.

#include "tests/agreement/sign_flips.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace kaustik::agreement {
namespace {

constexpr size_t blocks = 400;

/// Mean 1 in all blocks. Rare bright events make most of the noise, and each block shares half of
/// its noise with the next.
Replicates noisy(uint32_t seed) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> exponential(1);
  Replicates all;
  for (int r = 0; r < replicate_total; ++r) {
    std::vector<double> noise;
    for (size_t b = 0; b <= blocks; ++b) {
      const double e = exponential(random);
      noise.push_back((e * e * e - 6) / 60);
    }
    std::vector<float> row;
    for (size_t b = 0; b < blocks; ++b) row.push_back(float(1 + noise[b] + noise[b + 1]));
    all.push_back(std::move(row));
  }
  return all;
}

TEST(SignFlips, RejectTheRightShareOfEqualExpectations) {
  constexpr int trials = 200;
  constexpr double level = 0.05;
  int mean = 0, all_blocks = 0, worst = 0;
  for (uint32_t trial = 0; trial < trials; ++trial) {
    const Verdict verdict = compare(noisy(2 * trial), noisy(2 * trial + 1));
    mean += verdict.p_mean < level;
    all_blocks += verdict.p_blocks < level;
    worst += verdict.p_worst < level;
  }
  // 10 ± 3.1 of 200; Student's t rejects fewer where tails are wide.
  EXPECT_LE(mean, 22);
  EXPECT_LE(all_blocks, 22);
  EXPECT_GE(all_blocks, 1);
  EXPECT_LE(worst, 22);
}

/// Mean 1; all blocks of each quarter of the picture share their noise. So few regions may all look
/// less noisy than they are.
Replicates noisy_quarters(uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Replicates all;
  for (int r = 0; r < replicate_total; ++r) {
    std::vector<float>& row = all.emplace_back(blocks);
    std::array<double, 4> noise{};
    for (double& of_quarter : noise) of_quarter = 0.2 * normal(random);
    constexpr size_t columns = 20;
    for (size_t b = 0; b < blocks; ++b)
      row[b] = float(1 + noise[2 * (b / columns * 2 / columns) + b % columns * 2 / columns]);
  }
  return all;
}

/// Were noise another for other signs, such that make it small would be taken for a bias: about the
/// mean instead of zero, of twice as many pictures.
TEST(SignFlips, AllSignsAreEquals) {
  constexpr uint32_t trials = 1000;
  int rejected = 0;
  for (uint32_t trial = 0; trial < trials; ++trial)
    rejected += compare(noisy_quarters(2 * trial), noisy_quarters(2 * trial + 1)).p_blocks < 0.02;
  EXPECT_LE(rejected, 33);  // 20 ± 4.4
}

/// Mean 1, a fifth of it in events so rare that most blocks are without in all renders.
Replicates rare_events(uint32_t seed) {
  std::mt19937 random(seed);
  constexpr double chance = 0.02;
  std::bernoulli_distribution event(chance);
  std::normal_distribution<double> normal;
  Replicates all;
  for (int r = 0; r < replicate_total; ++r) {
    std::vector<float>& row = all.emplace_back();
    for (size_t b = 0; b < blocks; ++b)
      row.push_back(float(0.8 + 0.01 * normal(random) + (event(random) ? 0.2 / chance : 0)));
  }
  return all;
}

TEST(SignFlips, RareEventsAreNoBias) {
  Replicates exact;
  for (int r = 0; r < replicate_total; ++r) exact.emplace_back(blocks, 1.0f);
  constexpr int trials = 100;
  int rejected = 0, found = 0;
  for (uint32_t trial = 0; trial < trials; ++trial) {
    const Replicates tested = rare_events(trial);
    rejected += compare(tested, exact).rejects(0.05);
    found += compare(tested, exact, 0.2).rejects(0.05);
  }
  EXPECT_LE(rejected, 14);  // 5 ± 2.2
  EXPECT_EQ(found, trials);
}

TEST(SignFlips, FindABiasOfAll) {
  const Replicates a = noisy(1), b = noisy(2);
  EXPECT_FALSE(compare(a, b).rejects(1e-4));
  EXPECT_TRUE(compare(a, b, 0.1).rejects(1e-4));
  EXPECT_TRUE(compare(a, b, -0.1).rejects(1e-4));
  const double smallest = smallest_bias_found(a, b, 1e-4);
  EXPECT_GT(smallest, 1e-3);
  EXPECT_LT(smallest, 0.1);
}

TEST(SignFlips, FindABiasOfOneBlockAndOneWithoutAMean) {
  Replicates one = noisy(3), striped = one;
  for (auto& row : one) row[77] += 6;
  for (auto& row : striped)
    for (size_t b = 0; b < blocks; ++b) row[b] += b % 2 == 0 ? 0.15f : -0.15f;
  const Verdict of_one = compare(one, noisy(4)), of_stripes = compare(striped, noisy(4));
  EXPECT_EQ(of_one.worst_block, 77);
  EXPECT_LT(of_one.p_worst, 1e-5);
  EXPECT_GT(of_stripes.p_mean, 0.01);
  EXPECT_LT(of_stripes.p_blocks, 1e-4);
}

TEST(SignFlips, CountDarkBlocksAsOne) {
  Replicates dark = noisy(3), leak = dark, spot = dark;
  for (auto& row : dark) std::fill(row.begin() + 100, row.begin() + 200, 0.0f);
  leak = spot = dark;
  // All renders of one set have missed what those of the other have found. As a whole it would be
  // seen if it were much.
  for (size_t r = 0; r < size_t(replicate_total); ++r) leak[r][123] += 1e-5f * float(1 + r % 3);
  for (auto& row : spot) row[123] += 0.2f;
  const Replicates reference = [] {
    Replicates all = noisy(4);
    for (auto& row : all) std::fill(row.begin() + 100, row.begin() + 200, 0.0f);
    return all;
  }();
  EXPECT_NE(compare(leak, reference).worst_block, 123);
  EXPECT_EQ(compare(spot, reference).worst_block, 123);
}

TEST(SignFlips, AToleranceIsWhatItSays) {
  const Replicates a = noisy(5), b = noisy(6);
  EXPECT_GT(p_beyond(a, b, 0.3, 0.2), 0.01);
  EXPECT_LT(p_beyond(coarser(a, 20, 10), coarser(b, 20, 10), 0.05, 0.3), 1e-4);
}

TEST(SignFlips, ABiasThatIsToldMayBeThereAndNoMore) {
  const Replicates exact = noisy(7);
  const auto with = [](uint32_t seed, float factor) {
    Replicates all = noisy(seed);
    for (auto& row : all)
      for (size_t b = 0; b < blocks; ++b) row[b] += b < blocks / 2 ? factor : -factor;
    return all;
  };
  const auto coarse = [](const Replicates& fine) { return coarser(fine, 20, 10); };
  // What is told is noisy, too.
  Replicates told = with(9, 0.3f);
  for (auto& row : told)
    for (float& value : row) value -= 1;
  EXPECT_GT(p_beyond_told(coarse(with(8, 0.2f)), coarse(exact), coarse(told)), 0.01);
  EXPECT_GT(p_beyond_told(coarse(with(8, 0)), coarse(exact), coarse(told)), 0.01);
  EXPECT_LT(p_beyond_told(coarse(with(8, 0.6f)), coarse(exact), coarse(told)), 1e-4);
  EXPECT_LT(p_beyond_told(coarse(with(8, -0.3f)), coarse(exact), coarse(told)), 1e-4);
  EXPECT_LT(p_beyond_told(coarse(with(8, 0.2f)), coarse(exact), coarse(told), 0.3), 1e-4);
}

TEST(SignFlips, CoarserBlocksAreMeans) {
  Replicates rows = {{1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31}};
  EXPECT_EQ(coarser(rows, 4, 2)[0], (std::vector<float>{6, 10, 22, 26}));
}

}  // namespace
}  // namespace kaustik::agreement
