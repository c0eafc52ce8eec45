#include "kaustik/render/film_errors.h"

#include <algorithm>
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

/// Sums over pixels of luminances by replicate, apart for parts whose pixels have other passes.
class RegionSums {
 public:
  RegionSums(const FilmParts& parts, double pixels)
      : parts_(parts), pixels_(pixels), sums_(parts.count()), areas_(parts.count()) {}

  void add(size_t part, size_t replicate, double luminance) { sums_[part][replicate] += luminance; }
  void count_pixel(size_t part) { areas_[part] += 1; }
  /// The mean and its noise.
  KnownLuminance known() const;

 private:
  using Sums = std::array<double, replicate_count>;
  KnownLuminance known_of_one(const PassCounts& counts, Sums sums) const;

  const FilmParts& parts_;
  double pixels_;
  std::vector<Sums> sums_;
  std::vector<double> areas_;  ///< pixels
};

KnownLuminance RegionSums::known_of_one(const PassCounts& counts, Sums sums) const {
  for (double& sum : sums) sum /= pixels_;
  KnownLuminance known;
  known.mean =
      std::accumulate(sums.begin(), sums.end(), 0.0) / std::max(1.0, double(counts.count()));
  known.deviation = counts.is_known() ? std::sqrt(counts.variance(sums))
                                      : std::numeric_limits<double>::infinity();
  if (counts.is_known()) known.freedom = counts.freedom();
  return known;
}

KnownLuminance RegionSums::known() const {
  std::vector<size_t> met;
  for (size_t part = 0; part < areas_.size(); ++part)
    if (areas_[part] > 0) met.push_back(part);
  if (met.size() == 1) return known_of_one(parts_[met[0]], sums_[met[0]]);
  KnownLuminance known;
  // Parts share light paths: what a replicate is off by is that of all of them together.
  Sums off{}, shares{};
  double sum_of_variances = 0, sum_by_freedom = 0, most_freedom = 1;
  bool is_known = true;
  for (const size_t part : met) {
    const PassCounts& counts = parts_[part];
    const double n = counts.count();
    const double total = std::accumulate(sums_[part].begin(), sums_[part].end(), 0.0);
    known.mean += total / n / pixels_;
    is_known = is_known && counts.is_known();
    if (!is_known) continue;
    const double root = std::sqrt(counts.scale());
    double variance = 0;
    for (size_t r = 0; r < replicate_count; ++r) {
      const double of_part =
          (sums_[part][r] - counts.of_replicate(r) * total / n) / n / pixels_ * root;
      off[r] += of_part;
      shares[r] += counts.of_replicate(r) / n * areas_[part];
      variance += sqr(of_part);
    }
    sum_of_variances += variance;
    sum_by_freedom += sqr(variance) / counts.freedom();
    most_freedom = std::max(most_freedom, counts.freedom());
  }
  known.deviation = std::numeric_limits<double>::infinity();
  if (!is_known) return known;
  double variance = 0;
  for (const double of_replicate : off) variance += sqr(of_replicate);
  known.deviation = std::sqrt(variance);
  // Satterthwaite (1946), as if parts were independent and as if they shared all their noise;
  // whichever is less.
  known.freedom = std::min(most_freedom, freedom_of_shares(shares));
  if (sum_by_freedom > 0)
    known.freedom = std::min(known.freedom, sqr(sum_of_variances) / sum_by_freedom);
  known.freedom = std::max(1.0, known.freedom);
  return known;
}

}  // namespace

FilmErrors::FilmErrors(const Film& film) : film_(film), parts_(film) {
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
      std::array<double, replicate_count> sums;
      Fixed sum = 0;
      for (size_t r = 0; r < replicate_count; ++r) {
        add_to(sum, lines[r][place]);
        sums[r] = double_from(lines[r][place]);
      }
      const size_t pixel = size_t(y) * size_t(film_.width()) + size_t(x);
      const PassCounts& of_pixel = counts(pixel);
      luminances_[pixel] = {double_from(sum), of_pixel.is_known() ? of_pixel.variance(sums) : 0};
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
  return (bias_[pixel][0] + bias_[pixel][1]) / float(counts(pixel).count());
}

void FilmErrors::pool_variances() const {
  luminances();
  std::vector<double> variances(film_.pixel_count());
  const bool has_parts = parts_.count() > 1;
  parallel_blocks(variances.size(), 4096, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i)
      variances[i] = luminance_variance(i) * (has_parts ? double(counts(i).count()) : 1);
  });
  const Vec2i size(film_.width(), film_.height());
  variances_around_ =
      are_pixels_apart() ? std::move(variances) : means_around(variances, size, pool_reach);
  if (parts_.are_known() || are_pixels_apart()) return;
  // Of those around that are known.
  std::vector<double> is_known(film_.pixel_count());
  for (size_t i = 0; i < is_known.size(); ++i) is_known[i] = counts(i).is_known() ? 1 : 0;
  const std::vector<double> shares = means_around(is_known, size, pool_reach);
  for (size_t i = 0; i < shares.size(); ++i)
    if (shares[i] > 0) variances_around_[i] /= shares[i];
}

void FilmErrors::square_bias() {
  std::vector<std::array<float, bias_halves>> half_passes(parts_.count());
  const auto has_halves = [](const auto& halves) { return halves[0] > 0 && halves[1] > 0; };
  for (size_t part = 0; part < parts_.count(); ++part)
    for (uint32_t half = 0; half < bias_halves; ++half)
      half_passes[part][half] = float(parts_[part].of_half(half));
  if (std::none_of(half_passes.begin(), half_passes.end(), has_halves)) return;
  const int width = film_.width(), height = film_.height();
  const int reach = are_pixels_apart() ? 0 : bias_reach;
  const auto estimate = [&](size_t pixel, size_t half) {
    const auto& halves = half_passes[parts_.part_of(pixel)];
    return has_halves(halves) ? bias_[pixel][half] / halves[half] : Vec3f(0, 0, 0);
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

double FilmErrors::pooled_variance(size_t pixel) const {
  if (!counts(pixel).is_known()) return 0;
  std::call_once(is_pooled_, [this] { isolated([this] { pool_variances(); }); });
  const double own = luminance_variance(pixel);
  const double around =
      variances_around_[pixel] / (parts_.count() > 1 ? double(counts(pixel).count()) : 1);
  return (1 - share_around) * own + share_around * std::min(most_around * own, around);
}

double FilmErrors::variance_over_passes(double n, double sum, double sum_of_squares) {
  const double mean = sum / n;
  return std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1);
}

double FilmErrors::luminance_bias_sq_around(size_t pixel) const {
  return luminance_bias_sq_around_.empty() ? 0 : double(luminance_bias_sq_around_[pixel]);
}

Vec3f FilmErrors::of_pixel(size_t pixel, const ChannelSums& sums) const {
  Vec3f variance(0, 0, 0);
  const PassCounts& of_pixel = counts(pixel);
  const double passes = of_pixel.count();
  if (passes >= 2) {
    for (size_t lane = 0; lane < 3; ++lane)
      variance[int(lane)] =
          float(variance_over_passes(passes, sums.totals[lane], sums.squares[lane]));
    const double luminance_over_passes =
        variance_over_passes(passes, luminance_sum(pixel), sums.luminance_squares);
    if (of_pixel.is_known()) {
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
  const PassCounts& of_pixel = counts(pixel);
  KnownLuminance known;
  known.mean = luminance_sum(pixel) / std::max(1.0, double(of_pixel.count()));
  known.deviation = of_pixel.is_known() ? std::sqrt(pooled_variance(pixel))
                                        : std::numeric_limits<double>::infinity();
  known.bias = bias_sq_.empty() ? 0 : std::sqrt(std::max(0.0, double(bias_sq_[pixel][3])));
  if (of_pixel.is_known()) known.freedom = freedom(of_pixel);
  return known;
}

KnownLuminance FilmErrors::known(const PixelRegion& region) const {
  RegionSums sums(parts_, double(region.pixel_count()));
  double bias = 0;
  const PictureTiles& tiles = film_.tiles();
  const auto pixel_at = [&](int x, int y) { return size_t(y) * size_t(film_.width()) + size_t(x); };
  std::array<Fixed, PictureTiles::pixels> line;
  for (size_t tile = 0; tile < tiles.count(); ++tile) {
    const Vec2i first = tiles.first_pixel(tile);
    if (!region.meets({first.x, first.y, PictureTiles::side, PictureTiles::side})) continue;
    for (size_t r = 0; r < replicate_count; ++r) {
      film_.read(tile, film_.numbers().replicate_luminances + r, line);
      tiles.for_pixels_of(tile, [&](int x, int y, size_t place) {
        if (region.holds(x, y))
          sums.add(parts_.part_of(pixel_at(x, y)), r, double_from(line[place]));
      });
    }
    tiles.for_pixels_of(tile, [&](int x, int y, size_t) {
      if (!region.holds(x, y)) return;
      const size_t pixel = pixel_at(x, y);
      sums.count_pixel(parts_.part_of(pixel));
      if (film_.holds_bias() && counts(pixel).count() > 0)
        bias += double(photopic(mean_bias(pixel)));
    });
  }
  KnownLuminance known = sums.known();
  known.bias = std::abs(bias) / double(region.pixel_count());
  return known;
}

double FilmErrors::freedom(const PassCounts& of) const {
  return (are_pixels_apart() ? 1 : freedom_of_pool) * of.freedom();
}

double FilmErrors::freedom() const {
  return (are_pixels_apart() ? 1 : freedom_of_pool) * (parts_[0].replicates() - 1);
}

double FilmErrors::of_picture() const {
  if (!parts_.are_known()) return std::numeric_limits<double>::infinity();
  const size_t pixels = film_.pixel_count();
  luminances();
  const double dark = dark_share * std::abs(mean_luminance());
  const auto sum_of = [&](const auto& square_of) {
    return sum_over_blocks(pixels, 4096, [&](size_t begin, size_t end) {
      double block = 0;
      for (size_t i = begin; i < end; ++i)
        if (const double square = square_of(i); square != 0)
          block += square / sqr(std::abs(luminance_sum(i)) / double(counts(i).count()) + dark);
      return block;
    });
  };
  // Single products may be negative, and some do not make up for noise.
  const double noise = sum_of([this](size_t i) { return luminance_variance(i); });
  const double bias = sum_of([this](size_t i) { return luminance_bias_sq_around(i); });
  return std::sqrt((noise + std::max(0.0, bias)) / double(pixels));
}

double FilmErrors::mean_luminance() const {
  if (parts_.count() > 1)
    return sum_over_blocks(film_.pixel_count(), 4096,
                           [&](size_t begin, size_t end) {
                             double block = 0;
                             for (size_t i = begin; i < end; ++i)
                               block += luminance_sum(i) / double(counts(i).count());
                             return block;
                           }) /
           double(film_.pixel_count());
  double sum = 0;
  for (const Fixed part : film_.mean_luminances()) sum += double_from(part);
  return sum / double(film_.pass_count());
}

double FilmErrors::of_mean() const {
  if (!parts_.are_known()) return std::numeric_limits<double>::infinity();
  const double mean = mean_luminance();
  if (!(mean > 0)) return std::numeric_limits<double>::infinity();
  if (parts_.count() > 1) {
    const KnownLuminance all = known(PixelRegion{0, 0, film_.width(), film_.height()});
    return (student_t_quantile(0.975, all.freedom) * all.deviation + all.bias) / mean;
  }
  double bias = 0;
  if (film_.holds_bias())
    for (size_t i = 0; i < film_.pixel_count(); ++i) bias += double(photopic(mean_bias(i)));
  std::array<double, replicate_count> sums;
  for (size_t r = 0; r < replicate_count; ++r) sums[r] = double_from(film_.mean_luminances()[r]);
  const double t = student_t_quantile(0.975, parts_[0].freedom());
  const double noise = std::sqrt(parts_[0].variance(sums));
  return (t * noise + std::abs(bias) / double(film_.pixel_count())) / mean;
}

}  // namespace kaustik
