#include "kaustik/base/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "kaustik/base/log_gamma.h"

namespace kaustik {
namespace {

constexpr double tiny = 1e-300;
constexpr double relative_precision = 1e-15;
constexpr int most_terms = 100000;

/// P(a, x) by its power series; converges fast for x < a + 1.
double lower_gamma_series(double a, double x) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < most_terms && term > sum * relative_precision; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - log_gamma(a));
}

/// Q(a, x) by its continued fraction (Lentz's method); for x ≥ a + 1.
double upper_gamma_fraction(double a, double x) {
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
  for (int n = 1; n < most_terms; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    if (std::fabs(d) < tiny) d = tiny;
    c = b + numerator / c;
    if (std::fabs(c) < tiny) c = tiny;
    d = 1 / d;
    h *= d * c;
    if (std::fabs(d * c - 1) < relative_precision) break;
  }
  return h * std::exp(a * std::log(x) - x - log_gamma(a));
}

/// The continued fraction of I_x(a, b), without its leading factor (Lentz's method).
double beta_fraction(double a, double b, double x) {
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  if (std::fabs(d) < tiny) d = tiny;
  d = 1 / d;
  double h = d;
  const auto advance = [&](double numerator) {
    d = 1 + numerator * d;
    if (std::fabs(d) < tiny) d = tiny;
    c = 1 + numerator / c;
    if (std::fabs(c) < tiny) c = tiny;
    d = 1 / d;
    h *= d * c;
    return std::fabs(d * c - 1) < relative_precision;
  };
  for (int m = 1; m < most_terms; ++m) {
    advance(m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)));
    if (advance(-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)))) break;
  }
  return h;
}

}  // namespace

void RunningStatistics::merge(const RunningStatistics& other) {
  if (other.count_ == 0) return;
  const double total = double(count_ + other.count_);
  const double delta = other.mean_ - mean_;
  squares_ += other.squares_ + delta * delta * double(count_) * double(other.count_) / total;
  mean_ += delta * double(other.count_) / total;
  count_ += other.count_;
}

double RunningStatistics::standard_deviation() const { return std::sqrt(variance()); }
double RunningStatistics::standard_error() const {
  return count_ > 1 ? std::sqrt(variance() / double(count_)) : 0.0;
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_quantile(double probability) {
  if (!(probability >= 0 && probability <= 1)) return std::numeric_limits<double>::quiet_NaN();
  if (probability == 0) return -std::numeric_limits<double>::infinity();
  if (probability == 1) return std::numeric_limits<double>::infinity();
  // The lower half keeps full relative precision.
  if (probability > 0.5) return -normal_quantile(1 - probability);
  double low = -40, high = 0;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (normal_cdf(middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double z_test_p_value(double mean, double standard_error, double expected) {
  if (standard_error == 0) return mean == expected ? 1.0 : 0.0;
  return std::erfc(std::fabs(mean - expected) / (standard_error * std::numbers::sqrt2));
}

double upper_incomplete_gamma(double a, double x) {
  assert(a > 0 && x >= 0);
  if (x == 0) return 1;
  return x < a + 1 ? 1 - lower_gamma_series(a, x) : upper_gamma_fraction(a, x);
}

double incomplete_beta(double a, double b, double x) {
  assert(a > 0 && b > 0 && x >= 0 && x <= 1);
  if (x == 0 || x == 1) return x;
  const double factor = std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) +
                                 b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return factor * beta_fraction(a, b, x) / a;
  return 1 - factor * beta_fraction(b, a, 1 - x) / b;
}

double chi_square_p_value(double chi_square, int degrees_of_freedom) {
  if (degrees_of_freedom < 1) return 1;
  return upper_incomplete_gamma(0.5 * degrees_of_freedom, 0.5 * chi_square);
}

double chi_square_p_value(std::span<const double> observed, std::span<const double> expected,
                          double minimum_expected) {
  assert(observed.size() == expected.size());
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  struct Cell {
    double observed = 0, expected = 0;
  };
  std::vector<Cell> cells;
  Cell pooled;
  for (const size_t i : order) {
    if (expected[i] == 0 && observed[i] > 0) return 0;
    pooled.observed += observed[i];
    pooled.expected += expected[i];
    if (pooled.expected < minimum_expected) continue;
    cells.push_back(pooled);
    pooled = {};
  }
  if (cells.empty()) return 1;
  cells.back().observed += pooled.observed;
  cells.back().expected += pooled.expected;
  double chi_square = 0;
  for (const Cell& cell : cells)
    chi_square += (cell.observed - cell.expected) * (cell.observed - cell.expected) / cell.expected;
  return chi_square_p_value(chi_square, int(cells.size()) - 1);
}

double student_t_cdf(double t, double degrees_of_freedom) {
  const double tail = 0.5 * incomplete_beta(0.5 * degrees_of_freedom, 0.5,
                                            degrees_of_freedom / (degrees_of_freedom + t * t));
  return t > 0 ? 1 - tail : tail;
}

double student_t_quantile(double probability, double degrees_of_freedom) {
  assert(probability > 0 && probability < 1);
  if (probability == 0.5) return 0;
  if (probability > 0.5) return -student_t_quantile(1 - probability, degrees_of_freedom);
  double low = -1;
  while (student_t_cdf(low, degrees_of_freedom) > probability) low *= 2;
  double high = 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (student_t_cdf(middle, degrees_of_freedom) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

ConfidenceInterval student_t_interval(const RunningStatistics& values, double confidence) {
  if (values.count() < 2) return {values.mean(), std::numeric_limits<double>::infinity()};
  const double t = student_t_quantile(0.5 * (1 + confidence), double(values.count() - 1));
  return {values.mean(), t * values.standard_error()};
}

double t_test_p_value(const RunningStatistics& values, double expected,
                      double least_standard_error) {
  if (values.mean() == expected) return 1;
  const double error = std::max(values.standard_error(), least_standard_error);
  const double t = std::fabs(values.mean() - expected) / error;
  return 2 * student_t_cdf(-t, double(values.count() - 1));
}

double sidak_level(double level, int tests) { return -std::expm1(std::log1p(-level) / tests); }

}  // namespace kaustik
