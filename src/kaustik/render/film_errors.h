#pragma once
#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "kaustik/base/statistics.h"
#include "kaustik/render/film.h"
#include "kaustik/render/film_bias.h"
#include "kaustik/render/film_parts.h"

namespace kaustik {

/// Sums over passes of a pixel's channels.
struct ChannelSums {
  std::array<double, 3> totals{}, squares{};
  double luminance_squares = 0;
};

/// A luminance as it is known, photopic, in the picture's unit.
struct KnownLuminance {
  double mean = 0;
  /// Standard error of the mean by its noise; infinite: not known, with fewer than two replicates.
  double deviation = 0;
  double bias = 0;     ///< by how much the mean is expected to be off, on one side alone; 0: none
  double freedom = 1;  ///< degrees of freedom of the deviation
  /// Standard error of a pixel's bias, as far as the pixels around share it.
  double bias_deviation = 0;

  /// √(deviation² + bias²)
  double error() const;
  /// That holds the truth with this chance, 0 to 1: by Student's t of both deviations, widened by
  /// the bias.
  ConfidenceInterval interval(double confidence = 0.95) const;
};

/// How well a film's picture is known: from the noise of its passes, and from the bias that the
/// integrator estimates, if it does.
///
/// Noise: passes of one replicate stratify one another, so they are not independent; the replicates
/// are (Owen 1995). The standard error of a mean is that of the means of up to 16 replicates,
/// weighted by their passes. Of a single pixel two fifths of the variance are the mean over 5 × 5
/// pixels: where noise is that of rare events, a pixel whose samples have met none would know
/// neither that its mean is too low nor that its error is larger. Only their luminances are kept; a
/// channel's error is that over passes, times what replicates make of that of the luminance.
///
/// Bias: FilmBias, relative to |L| + 0.01 M, where L is the pixel's luminance and M the picture's
/// mean. With passes of one half of the replicates alone it counts as zero.
///
/// Regions: a pixel's passes are those of the picture and those of its regions, by replicate.
/// Variances around a pixel count by the variance of a pass.
class FilmErrors {
 public:
  /// `film` must outlive this and not change.
  explicit FilmErrors(const Film& film);

  /// Standard error of the pixel's mean per channel, √(noise² + bias²); the noise counts as zero
  /// with fewer than two passes of the pixel.
  Vec3f of_pixel(size_t pixel, const ChannelSums& sums) const;
  /// What of_pixel() takes of all pixels, by all threads. Without this the first call makes it.
  void prepare_pixels() const;
  KnownLuminance known(size_t pixel) const;
  /// The mean over a region, which must not be empty and lie in the picture: its noise is that of
  /// the region's own means by replicate, since pixels share photons; its bias that of the signed
  /// estimates, up to half too large where light is smooth.
  /// Parts whose pixels have other passes weigh by their area, in each replicate.
  KnownLuminance known(const PixelRegion& region) const;
  /// The interval of the pixel's luminance.
  ConfidenceInterval luminance(size_t pixel, double confidence = 0.95) const {
    return known(pixel).interval(confidence);
  }
  /// Degrees of freedom of the noise that a pixel's interval has, outside of regions with passes of
  /// their own.
  double freedom() const;
  bool are_pixels_apart() const { return film_.layers().pixels_are_apart; }
  /// Square root of the mean over pixels of (e/(|L| + 0.01 M))², where e is the standard error of
  /// the pixel's luminance (noise and bias). Infinite with fewer than two replicates, 0 for a black
  /// picture.
  double of_picture() const;
  /// Half the width of the 95 % confidence interval of the picture's mean luminance by Student's t,
  /// plus its bias, relative to it; infinite with fewer than two replicates.
  double of_mean() const;
  /// Only if the film holds bias.
  Vec3f mean_bias(size_t pixel) const;

 private:
  struct Luminance {
    double sum = 0;       ///< over the passes
    double variance = 0;  ///< of the mean; 0 while it is not known
  };
  const PassCounts& counts(size_t pixel) const { return parts_.of_pixel(pixel); }
  double freedom(const PassCounts& of) const;
  double luminance_sum(size_t pixel) const { return luminances()[pixel].sum; }
  double luminance_variance(size_t pixel) const { return luminances()[pixel].variance; }
  /// The same, as neighbours tell of it too.
  double pooled_variance(size_t pixel) const;
  /// Of a mean over passes as if they were independent.
  static double variance_over_passes(double passes, double sum, double sum_of_squares);
  /// |L| + 0.01 M; 1 where both are 0.
  double light(size_t pixel, double mean_luminance) const;
  /// Of the channel; nothing if none is known.
  const FilmBias::Squares* bias_squares(size_t channel) const;
  double pixel_bias_sq(size_t pixel, size_t channel) const;
  void sum_up_luminances() const;
  /// Only once one is asked for: the error of the mean needs none.
  const std::vector<Luminance>& luminances() const;
  /// Of the picture.
  double mean_luminance() const;
  /// Only once a single pixel is asked for: the picture's error is looked at after every pass.
  void pool_variances() const;

  const Film& film_;
  FilmParts parts_;
  mutable std::once_flag is_summed_up_, is_pooled_;
  mutable std::vector<Luminance> luminances_;  ///< by pixel
  /// Of the luminance: means over neighbours, of the variance of a pass if there are regions.
  mutable std::vector<double> variances_around_;
  std::optional<FilmBias> bias_;
  /// Each only once it is asked for.
  mutable std::array<std::once_flag, FilmBias::channels> is_squared_;
  mutable std::array<FilmBias::Squares, FilmBias::channels> bias_squares_;
};

}  // namespace kaustik
