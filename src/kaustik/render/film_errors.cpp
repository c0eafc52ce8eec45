#include "kaustik/render/film_errors.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"
#include "kaustik/transport/block_means.h"

namespace kaustik {
namespace {

/// Pixels on either side that the square of a pixel's bias is averaged with.
constexpr int bias_reach = 2;
/// The pixel's own counts where it is larger, and its root more than so many of its standard
/// errors.
constexpr float least_bias_errors = 3;
/// Pixels on either side that a variance is averaged with, of which they tell this share: few
/// samples of rare events have often met none of them, and are too sure of too low a mean. Never
/// more than so many times the pixel's own, which beside edges is another.
constexpr int pool_reach = 2;
constexpr double share_around = 0.4, most_around = 10;
/// Degrees of freedom of such a variance over those of one pixel, were neighbours independent
/// (Satterthwaite 1946).
constexpr double freedom_of_pool = [] {
  constexpr double pixels = sqr(2 * pool_reach + 1), own = 1 - share_around * (1 - 1 / pixels);
  return 1 / (sqr(own) + sqr(1 - own) / (pixels - 1));
}();
/// Rounded squares tell nothing if the luminance's variance over passes is less than this share of
/// that of its replicates: of normal noise it is so in one of a million pixels.
constexpr double least_over_passes = 0.25;
/// Share of the picture's mean luminance under which a pixel's own counts less and less.
constexpr double dark_share = 0.01;

/// Of R, G, B and the luminance.
using Squares = std::array<float, 4>;
Squares squares(const Vec3f& a, const Vec3f& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z, photopic(a) * photopic(b)};
}

/// Of a pixel's bias, or of those around it.
struct BiasSquares {
  Squares products{};   ///< of the two halves' estimates: the mean is the bias squared
  Squares variances{};  ///< of the mean of the two
};

/// Means of each value with its neighbours, as far as `reach`, in a line of `count` values that are
/// `step` apart; at the ends of those that are there. Calls take(i, mean).
template <typename Take>
void smooth_line(const BiasSquares* values, int count, size_t step, int reach, const Take& take) {
  for (int i = 0; i < count; ++i) {
    const int first = std::max(0, i - reach), last = std::min(count - 1, i + reach);
    const float share = 1 / float(last - first + 1);
    BiasSquares mean;
    for (int k = first; k <= last; ++k)
      for (size_t c = 0; c < mean.products.size(); ++c) {
        mean.products[c] += values[size_t(k) * step].products[c] * share;
        mean.variances[c] += values[size_t(k) * step].variances[c] * share;
      }
    take(size_t(i), mean);
  }
}

/// What a pixel's bias counts for, by the means of its two halves' estimates and by those around.
Squares pixel_bias(const Vec3f& even, const Vec3f& odd, const BiasSquares& around) {
  const Vec3f mean = (even + odd) * 0.5f, off = (even - odd) * 0.5f;
  const Squares own = squares(mean, mean), own_variance = squares(off, off);
  Squares result = around.products;
  for (size_t c = 0; c < result.size(); ++c)
    if (own[c] > sqr(least_bias_errors) * std::max(own_variance[c], around.variances[c]))
      result[c] = std::max(result[c], own[c]);
  return result;
}

/// Of an interval that holds the truth with this chance if what is estimated is a bias away from it
/// and its deviation is known with so many degrees of freedom: t of both sides where there is no
/// bias, of one side alone where there is much.
double half_width_with_bias(double deviation, double bias, double confidence, double freedom) {
  const double most = student_t_quantile(0.5 + confidence / 2, freedom);
  if (!(deviation > 0)) return bias;
  const double least = student_t_quantile(confidence, freedom), shift = bias / deviation;
  double low = least + shift, high = most + shift;
  for (int step = 0; step < 20; ++step) {
    const double middle = 0.5 * (low + high);
    const double held =
        student_t_cdf(middle - shift, freedom) - student_t_cdf(-middle - shift, freedom);
    (held < confidence ? low : high) = middle;
  }
  return deviation * high;
}

}  // namespace

FilmErrors::FilmErrors(const Film& film) : film_(film) {
  for (uint32_t r = 0; r < replicate_count; ++r) {
    replicate_passes_[r] = film.passes().count_of_remainder(r, replicate_count);
    replicates_ += replicate_passes_[r] > 0 ? 1 : 0;
  }
  if (!film.holds_bias()) return;
  sum_up_bias();
  square_bias();
}

void FilmErrors::sum_up_luminances() const {
  luminances_.resize(film_.pixel_count());
  const PictureTiles& tiles = film_.tiles();
  parallel_blocks(tiles.count(), 1, [&](size_t tile, size_t, size_t) {
    std::vector<std::array<Fixed, PictureTiles::pixels>> lines(replicate_count);
    for (size_t r = 0; r < replicate_count; ++r)
      film_.read(tile, film_.numbers().replicate_luminances + r, lines[r]);
    tiles.for_pixels_of(tile, [&](int x, int y, size_t place) {
      std::array<Fixed, replicate_count> sums;
      Fixed sum = 0;
      for (size_t r = 0; r < replicate_count; ++r) add_to(sum, sums[r] = lines[r][place]);
      luminances_[size_t(y) * size_t(film_.width()) + size_t(x)] = {
          double_from(sum), is_known() ? variance_by_replicates(sums.data()) : 0};
    });
  });
}

const std::vector<FilmErrors::Luminance>& FilmErrors::luminances() const {
  std::call_once(is_summed_up_, [this] { isolated([this] { sum_up_luminances(); }); });
  return luminances_;
}

void FilmErrors::sum_up_bias() {
  bias_.resize(film_.pixel_count());
  const PictureTiles& tiles = film_.tiles();
  parallel_blocks(tiles.count(), 1, [&](size_t tile, size_t, size_t) {
    std::array<Fixed, PictureTiles::pixels> line;
    for (size_t half = 0; half < bias_halves; ++half)
      for (size_t lane = 0; lane < FilmNumbers::lanes; ++lane) {
        film_.read(tile, film_.numbers().bias + half * FilmNumbers::lanes + lane, line);
        tiles.for_pixels_of(tile, [&](int x, int y, size_t place) {
          bias_[size_t(y) * size_t(film_.width()) + size_t(x)][half][int(lane)] =
              float(double_from(line[place]));
        });
      }
  });
}

Vec3f FilmErrors::mean_bias(size_t pixel) const {
  return (bias_[pixel][0] + bias_[pixel][1]) / float(film_.pass_count());
}

void FilmErrors::pool_variances() const {
  luminances();
  std::vector<double> variances(film_.pixel_count());
  parallel_blocks(variances.size(), 4096, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) variances[i] = luminance_variance(i);
  });
  variances_around_ = are_pixels_apart()
                          ? std::move(variances)
                          : means_around(variances, {film_.width(), film_.height()}, pool_reach);
}

void FilmErrors::square_bias() {
  std::array<float, bias_halves> half_passes{};
  for (uint32_t half = 0; half < bias_halves; ++half)
    half_passes[half] = float(film_.passes().count_of_remainder(half, bias_halves));
  if (!(half_passes[0] > 0 && half_passes[1] > 0)) return;
  const int width = film_.width(), height = film_.height();
  const int reach = are_pixels_apart() ? 0 : bias_reach;
  const auto estimate = [&](size_t pixel, size_t half) {
    return bias_[pixel][half] / half_passes[half];
  };
  std::vector<BiasSquares> rows(film_.pixel_count());
  parallel_blocks(size_t(height), 1, [&](size_t y, size_t, size_t) {
    std::vector<BiasSquares> row(static_cast<size_t>(width));
    const size_t begin = y * row.size();
    for (size_t x = 0; x < row.size(); ++x) {
      const Vec3f even = estimate(begin + x, 0), odd = estimate(begin + x, 1);
      const Vec3f off = (even - odd) * 0.5f;
      row[x] = {squares(even, odd), squares(off, off)};
    }
    smooth_line(row.data(), width, 1, reach,
                [&](size_t x, const BiasSquares& mean) { rows[begin + x] = mean; });
  });
  bias_sq_.resize(film_.pixel_count());
  luminance_bias_sq_around_.resize(film_.pixel_count());
  parallel_blocks(size_t(width), 1, [&](size_t x, size_t, size_t) {
    smooth_line(rows.data() + x, height, size_t(width), reach,
                [&](size_t y, const BiasSquares& around) {
                  const size_t pixel = y * size_t(width) + x;
                  bias_sq_[pixel] = pixel_bias(estimate(pixel, 0), estimate(pixel, 1), around);
                  luminance_bias_sq_around_[pixel] = around.products[3];
                });
  });
}

double FilmErrors::variance_by_replicates(const Fixed* sums) const {
  std::array<double, replicate_count> values;
  for (size_t r = 0; r < replicate_count; ++r) values[r] = double_from(sums[r]);
  return variance_by_replicates(values);
}

double FilmErrors::variance_by_replicates(const std::array<double, replicate_count>& sums) const {
  double total = 0;
  for (const double sum : sums) total += sum;
  const double mean = total / passes();
  double squares = 0;
  for (size_t r = 0; r < replicate_count; ++r)
    squares += sqr(sums[r] - replicate_passes_[r] * mean);
  return squares / sqr(passes()) * replicates_ / (replicates_ - 1);
}

double FilmErrors::pooled_variance(size_t pixel) const {
  if (!is_known()) return 0;
  std::call_once(is_pooled_, [this] { isolated([this] { pool_variances(); }); });
  const double own = luminance_variance(pixel);
  return (1 - share_around) * own +
         share_around * std::min(most_around * own, variances_around_[pixel]);
}

double FilmErrors::variance_over_passes(double sum, double sum_of_squares) const {
  const double n = passes(), mean = sum / n;
  return std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1);
}

double FilmErrors::luminance_bias_sq_around(size_t pixel) const {
  return luminance_bias_sq_around_.empty() ? 0 : double(luminance_bias_sq_around_[pixel]);
}

Vec3f FilmErrors::of_pixel(size_t pixel, const ChannelSums& sums) const {
  Vec3f variance(0, 0, 0);
  if (film_.pass_count() >= 2) {
    for (size_t lane = 0; lane < 3; ++lane)
      variance[int(lane)] = float(variance_over_passes(sums.totals[lane], sums.squares[lane]));
    const double luminance_over_passes =
        variance_over_passes(luminance_sum(pixel), sums.luminance_squares);
    if (is_known()) {
      const double pooled = pooled_variance(pixel);
      // Squares that are rounded may not tell noise that is next to nothing beside the tile's
      // light: then all channels have the luminance's.
      if (luminance_over_passes > least_over_passes * luminance_variance(pixel))
        variance *= float(pooled / luminance_over_passes);
      else
        variance = Vec3f(float(pooled), float(pooled), float(pooled));
    }
  }
  Vec3f error;
  for (int lane = 0; lane < 3; ++lane)
    error[lane] = std::sqrt(variance[lane] +
                            (bias_sq_.empty() ? 0 : std::max(0.0f, bias_sq_[pixel][size_t(lane)])));
  return error;
}

ConfidenceInterval KnownLuminance::interval(double confidence) const {
  if (!std::isfinite(deviation)) return {mean, std::numeric_limits<double>::infinity()};
  return {mean, half_width_with_bias(deviation, bias, confidence, freedom)};
}

double KnownLuminance::error() const { return std::hypot(deviation, bias); }

KnownLuminance FilmErrors::known(size_t pixel) const {
  KnownLuminance known;
  known.mean = luminance_sum(pixel) / std::max(1.0, passes());
  known.deviation =
      is_known() ? std::sqrt(pooled_variance(pixel)) : std::numeric_limits<double>::infinity();
  known.bias = bias_sq_.empty() ? 0 : std::sqrt(std::max(0.0, double(bias_sq_[pixel][3])));
  if (is_known()) known.freedom = freedom();
  return known;
}

KnownLuminance FilmErrors::known(const PixelRegion& region) const {
  std::array<double, replicate_count> sums{};
  double bias = 0;
  const PictureTiles& tiles = film_.tiles();
  std::array<Fixed, PictureTiles::pixels> line;
  const auto is_in = [&](int x, int y) {
    return x >= region.x && x < region.x + region.width && y >= region.y &&
           y < region.y + region.height;
  };
  for (size_t tile = 0; tile < tiles.count(); ++tile) {
    bool meets = false;
    tiles.for_pixels_of(tile, [&](int x, int y, size_t) { meets = meets || is_in(x, y); });
    if (!meets) continue;
    for (size_t r = 0; r < replicate_count; ++r) {
      film_.read(tile, film_.numbers().replicate_luminances + r, line);
      tiles.for_pixels_of(tile, [&](int x, int y, size_t place) {
        if (is_in(x, y)) sums[r] += double_from(line[place]);
      });
    }
    if (!film_.holds_bias() || film_.pass_count() == 0) continue;
    tiles.for_pixels_of(tile, [&](int x, int y, size_t) {
      if (is_in(x, y))
        bias += double(photopic(mean_bias(size_t(y) * size_t(film_.width()) + size_t(x))));
    });
  }
  const double pixels = double(region.width) * region.height;
  for (double& sum : sums) sum /= pixels;
  KnownLuminance known;
  known.mean = std::accumulate(sums.begin(), sums.end(), 0.0) / std::max(1.0, passes());
  known.deviation = is_known() ? std::sqrt(variance_by_replicates(sums))
                               : std::numeric_limits<double>::infinity();
  known.bias = std::abs(bias) / pixels;
  if (is_known()) known.freedom = replicates_ - 1;
  return known;
}

double FilmErrors::freedom() const {
  return (are_pixels_apart() ? 1 : freedom_of_pool) * (replicates_ - 1);
}

double FilmErrors::of_picture() const {
  if (!is_known()) return std::numeric_limits<double>::infinity();
  const size_t pixels = film_.pixel_count();
  luminances();
  double sum_of_luminances = 0;
  for (const Fixed part : film_.mean_luminances()) sum_of_luminances += double_from(part);
  const double dark = dark_share * std::abs(sum_of_luminances) / passes();
  const auto sum_of = [&](const auto& square_of) {
    return sum_over_blocks(pixels, 4096, [&](size_t begin, size_t end) {
      double block = 0;
      for (size_t i = begin; i < end; ++i)
        if (const double square = square_of(i); square != 0)
          block += square / sqr(std::abs(luminance_sum(i)) / passes() + dark);
      return block;
    });
  };
  // Single products may be negative, and some do not make up for noise.
  const double noise = sum_of([this](size_t i) { return luminance_variance(i); });
  const double bias = sum_of([this](size_t i) { return luminance_bias_sq_around(i); });
  return std::sqrt((noise + std::max(0.0, bias)) / double(pixels));
}

double FilmErrors::of_mean() const {
  double sum = 0, bias = 0;
  for (const Fixed part : film_.mean_luminances()) sum += double_from(part);
  if (!is_known() || !(sum > 0)) return std::numeric_limits<double>::infinity();
  if (film_.holds_bias())
    for (size_t i = 0; i < film_.pixel_count(); ++i) bias += double(photopic(mean_bias(i)));
  const double t = student_t_quantile(0.975, replicates_ - 1);
  const double noise = std::sqrt(variance_by_replicates(film_.mean_luminances().data()));
  return (t * noise + std::abs(bias) / double(film_.pixel_count())) / (sum / passes());
}

}  // namespace kaustik
