#pragma once
// Means with their errors, and the tests that statistical claims are checked with.

#include <cstdint>
#include <span>

namespace kaustik {

/// Mean and variance of a stream of numbers without cancellation (Welford 1962); partial ones can
/// be merged (Chan, Golub and LeVeque 1979).
class RunningStatistics {
 public:
  void add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / double(count_);
    squares_ += delta * (value - mean_);
  }
  void merge(const RunningStatistics& other);

  int64_t count() const { return count_; }
  /// 0 while empty.
  double mean() const { return mean_; }
  /// Unbiased estimate of the variance of one number; 0 with fewer than two.
  double variance() const { return count_ > 1 ? squares_ / double(count_ - 1) : 0.0; }
  double standard_deviation() const;
  /// Of the mean; 0 with fewer than two.
  double standard_error() const;

 private:
  int64_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;  ///< sum of squared deviations from the mean
};

double normal_cdf(double x);
/// Inverse of normal_cdf; −∞ at 0, +∞ at 1, NaN outside [0, 1].
double normal_quantile(double probability);

/// Two-sided p value of a mean with its standard error against the expected mean. A standard error
/// of zero gives 1 if the two are equal, else 0.
double z_test_p_value(double mean, double standard_error, double expected);
inline double z_test_p_value(const RunningStatistics& s, double expected) {
  return z_test_p_value(s.mean(), s.standard_error(), expected);
}

/// Regularised incomplete gamma function Q(a, x) = Γ(a, x)/Γ(a), a > 0, x ≥ 0.
double upper_incomplete_gamma(double a, double x);
/// Regularised incomplete beta function I_x(a, b), a and b > 0, x in [0, 1].
double incomplete_beta(double a, double b, double x);

/// Chance of a chi-square value this large or larger; 1 without degrees of freedom.
double chi_square_p_value(double chi_square, int degrees_of_freedom);
/// Pearson's test of counts against expected counts of the same total. Cells with fewer than
/// `minimum_expected` expected hits are pooled, the rarest first, so that the approximation holds;
/// hits where none at all are expected give 0. Both spans must be equally long.
double chi_square_p_value(std::span<const double> observed, std::span<const double> expected,
                          double minimum_expected = 5);

double student_t_cdf(double t, double degrees_of_freedom);
/// Inverse of student_t_cdf for probabilities in (0, 1).
double student_t_quantile(double probability, double degrees_of_freedom);

/// The interval mean ± half_width that holds the true mean with the given confidence.
struct ConfidenceInterval {
  double mean = 0;
  double half_width = 0;
};
/// By Student's t over independent values; the half width is infinite with fewer than two.
ConfidenceInterval student_t_interval(const RunningStatistics& values, double confidence = 0.95);

/// Two-sided p value of Student's t for independent values against the expected mean. No error
/// counts that is smaller than `least_standard_error`: expected values are written with few digits.
double t_test_p_value(const RunningStatistics& values, double expected,
                      double least_standard_error = 0);

/// Šidák (1967): the level for each of `tests` independent tests under which all of them together
/// reject a true hypothesis with chance `level`.
double sidak_level(double level, int tests);

}  // namespace kaustik
