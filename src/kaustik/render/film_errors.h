#pragma once
#include <vector>

#include "kaustik/base/statistics.h"
#include "kaustik/render/film.h"

namespace kaustik {

/// How well a film's picture is known: from the noise of its passes, and from the bias that the
/// integrator estimates, if it does.
///
/// Noise: passes of one replicate stratify one another, so they are not independent; the replicates
/// are (Owen 1995). The standard error of a mean is that of the means of up to 16 replicates,
/// weighted by their passes. Only their luminances are kept; a channel's error is that over passes,
/// times what replicates make of that of the luminance.
///
/// Bias: its estimates are as noisy as the picture, and the magnitude of noise is not zero. So it
/// is averaged over 5 × 5 pixels before the magnitude is taken. What is left of the noise makes
/// the error too large, never too small.
class FilmErrors {
 public:
  /// `film` must outlive this and not change.
  explicit FilmErrors(const Film& film);

  /// Standard error of the pixel's mean per channel, √(noise² + bias²); the noise counts as zero
  /// with fewer than two passes.
  Vec3f of_pixel(size_t pixel) const;
  /// The interval of the pixel's luminance by Student's t, widened by the bias; infinite with fewer
  /// than two replicates.
  ConfidenceInterval luminance(size_t pixel, double confidence = 0.95) const;
  /// Square root of the mean over pixels of (e/(|L| + 0.01 M))², where e is the standard error of
  /// the pixel's luminance L (noise and bias), M the picture's mean luminance. Infinite with fewer
  /// than two replicates, 0 for a black picture.
  double of_picture() const;
  /// Half the width of the 95 % confidence interval of the picture's mean luminance by Student's t,
  /// plus its bias, relative to it; infinite with fewer than two replicates.
  double of_mean() const;

 private:
  bool is_known() const { return replicates_ >= 2; }
  double passes() const { return double(film_.pass_count()); }
  /// Of the mean of what was summed up by replicate.
  double variance_by_replicates(const Fixed* sums) const;
  double luminance_sum(size_t pixel) const;
  double luminance_variance(size_t pixel) const;
  /// Of a mean over passes as if they were independent.
  double variance_over_passes(double sum, double sum_of_squares) const;
  double bias_luminance(size_t pixel) const;
  void smooth_bias();

  const Film& film_;
  std::array<uint32_t, replicate_count> replicate_passes_{};
  int replicates_ = 0;       ///< that have passes
  std::vector<Vec3f> bias_;  ///< averaged over neighbours; empty: none is estimated
};

}  // namespace kaustik
