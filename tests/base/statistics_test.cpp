#include "kaustik/base/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kaustik {
namespace {

TEST(running_statistics, agrees_with_the_definition) {
  const std::vector<double> values = {1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16};
  RunningStatistics s;
  for (const double v : values) s.add(v);
  EXPECT_EQ(s.count(), 4);
  EXPECT_DOUBLE_EQ(s.mean(), 1e9 + 10);
  EXPECT_DOUBLE_EQ(s.variance(), 30);
  EXPECT_DOUBLE_EQ(s.standard_deviation(), std::sqrt(30));
  EXPECT_DOUBLE_EQ(s.standard_error(), std::sqrt(7.5));
}

TEST(running_statistics, is_defined_when_nearly_empty) {
  RunningStatistics s;
  EXPECT_EQ(s.mean(), 0);
  EXPECT_EQ(s.variance(), 0);
  s.add(5);
  EXPECT_EQ(s.mean(), 5);
  EXPECT_EQ(s.variance(), 0);
  EXPECT_TRUE(std::isinf(student_t_interval(s).half_width));
}

TEST(running_statistics, merges_as_if_added_one_by_one) {
  RunningStatistics all, a, b;
  for (int i = 0; i < 100; ++i) {
    const double v = std::sin(i * 1.7) * i;
    all.add(v);
    (i < 37 ? a : b).add(v);
  }
  a.merge(b);
  a.merge(RunningStatistics());
  EXPECT_EQ(a.count(), 100);
  EXPECT_NEAR(a.mean(), all.mean(), 1e-12);
  EXPECT_NEAR(a.variance(), all.variance(), 1e-9);
  RunningStatistics empty;
  empty.merge(all);
  EXPECT_DOUBLE_EQ(empty.mean(), all.mean());
}

// Figures of printed tables (Abramowitz and Stegun 26).
TEST(distributions, normal) {
  EXPECT_NEAR(normal_cdf(0), 0.5, 1e-15);
  EXPECT_NEAR(normal_cdf(1.959963984540054), 0.975, 1e-14);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(1e-9), -5.997807015, 1e-8);
  EXPECT_TRUE(std::isinf(normal_quantile(0)));
  EXPECT_TRUE(std::isnan(normal_quantile(1.5)));
}

TEST(distributions, chi_square) {
  EXPECT_NEAR(chi_square_p_value(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_p_value(18.307038053275146, 10), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_p_value(1074.679446, 1000), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_p_value(2.0, 2), std::exp(-1.0), 1e-14);
  EXPECT_EQ(chi_square_p_value(0.0, 5), 1);
  EXPECT_EQ(chi_square_p_value(7.0, 0), 1);
}

TEST(distributions, student_t) {
  EXPECT_NEAR(student_t_quantile(0.975, 15), 2.131449546, 1e-8);
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.70620474, 1e-7);
  EXPECT_NEAR(student_t_quantile(0.995, 4), 4.604094871, 1e-8);
  EXPECT_NEAR(student_t_quantile(0.05, 15), -1.753050356, 1e-8);
  EXPECT_NEAR(student_t_quantile(0.975, 1e6), 1.95996636, 1e-6);
  EXPECT_EQ(student_t_quantile(0.5, 3), 0);
  // One degree of freedom is the Cauchy distribution.
  EXPECT_NEAR(student_t_cdf(1, 1), 0.75, 1e-14);
}

TEST(distributions, incomplete_beta) {
  EXPECT_NEAR(incomplete_beta(2, 3, 0.5), 0.6875, 1e-13);
  EXPECT_NEAR(incomplete_beta(0.5, 0.5, 0.25), 1.0 / 3.0, 1e-13);
  EXPECT_EQ(incomplete_beta(2, 3, 0), 0);
  EXPECT_EQ(incomplete_beta(2, 3, 1), 1);
}

TEST(distributions, sidak) {
  EXPECT_NEAR(sidak_level(0.05, 1), 0.05, 1e-15);
  const double level = sidak_level(0.01, 200);
  EXPECT_NEAR(1 - std::pow(1 - level, 200), 0.01, 1e-12);
}

TEST(student_t_interval, covers_as_often_as_it_says) {
  // Means of 4 numbers that are nearly normal (sums of 12 uniform ones).
  uint64_t state = 1;
  const auto uniform = [&] {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return double(state >> 11) * 0x1p-53;
  };
  const int trials = 20000;
  int covered = 0;
  for (int trial = 0; trial < trials; ++trial) {
    RunningStatistics s;
    for (int i = 0; i < 4; ++i) {
      double x = -6;
      for (int j = 0; j < 12; ++j) x += uniform();
      s.add(x);
    }
    const ConfidenceInterval interval = student_t_interval(s, 0.9);
    covered += std::fabs(interval.mean) <= interval.half_width;
  }
  const double error = std::sqrt(0.9 * 0.1 / trials);
  EXPECT_GT(z_test_p_value(double(covered) / trials, error, 0.9), 1e-3);
  // The normal quantile instead of Student's would cover 80 %.
  EXPECT_LT(z_test_p_value(double(covered) / trials, error, 0.8), 1e-3);
}

TEST(z_test, takes_the_error_into_account) {
  EXPECT_NEAR(z_test_p_value(1.1, 0.05, 1.0), 0.0455002639, 1e-9);
  EXPECT_EQ(z_test_p_value(1.0, 0.0, 1.0), 1);
  EXPECT_EQ(z_test_p_value(1.1, 0.0, 1.0), 0);
}

TEST(chi_square_of_counts, accepts_the_truth_and_finds_two_percent) {
  // 64 cells; a fixed-seed generator throws 10^6 balls. The twin has half of the cells 2 % larger.
  uint64_t state = 7;
  std::vector<double> observed(64), right(64, 1e6 / 64), wrong(64);
  for (int i = 0; i < 1000000; ++i) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    observed[size_t(state >> 58)] += 1;
  }
  for (size_t i = 0; i < 64; ++i) wrong[i] = right[i] * (i < 32 ? 1.01 : 0.99);
  EXPECT_GT(chi_square_p_value(observed, right), 1e-3);
  EXPECT_LT(chi_square_p_value(observed, wrong), 1e-6);
}

TEST(chi_square_of_counts, pools_rare_cells) {
  // Unpooled, the one hit in the cell of expectation 0.001 would weigh 998.
  const std::vector<double> expected = {0.001, 2, 2, 2, 50, 43.999},
                            observed = {1, 2, 2, 1, 50, 44};
  EXPECT_GT(chi_square_p_value(observed, expected), 0.5);
  EXPECT_LT(chi_square_p_value(observed, expected, 0.0), 1e-6);
}

TEST(chi_square_of_counts, rejects_hits_where_none_can_be) {
  const std::vector<double> expected = {0, 50, 50}, observed = {1, 50, 49}, none = {0, 50, 50};
  EXPECT_EQ(chi_square_p_value(observed, expected), 0);
  EXPECT_EQ(chi_square_p_value(none, expected), 1);
}

TEST(StudentT, TellsMeansApart) {
  RunningStatistics values;
  for (const double value : {0.0, 1.0, 2.0}) values.add(value);
  // t = 1/(1/√3) with 2 degrees of freedom: p = 1 − t/√(t² + 2) = 1 − √(3/5).
  EXPECT_NEAR(t_test_p_value(values, 2), 1 - std::sqrt(0.6), 1e-12);
  EXPECT_EQ(t_test_p_value(values, 1), 1);
  // A larger error: t = 1.
  EXPECT_NEAR(t_test_p_value(values, 2, 1), 1 - std::sqrt(1.0 / 3), 1e-12);
  RunningStatistics constant;
  for (int i = 0; i < 3; ++i) constant.add(1);
  EXPECT_EQ(t_test_p_value(constant, 1.1), 0);
  EXPECT_GT(t_test_p_value(constant, 1.1, 0.1), 0.4);
}

}  // namespace
}  // namespace kaustik
