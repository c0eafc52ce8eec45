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
  if (film.holds_bias()) bias_.emplace(film, parts_);
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

Vec3f FilmErrors::mean_bias(size_t pixel) const {
  return bias_->sum(pixel) / float(counts(pixel).count());
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

double FilmErrors::light(size_t pixel, double mean_luminance) const {
  const double own = std::abs(luminance_sum(pixel)) / std::max(1.0, double(counts(pixel).count()));
  const double light = own + dark_share * std::abs(mean_luminance);
  return light > 0 ? light : 1;
}

const FilmBias::Squares* FilmErrors::bias_squares(size_t channel) const {
  if (!bias_ || !bias_->is_known()) return nullptr;
  luminances();
  std::call_once(is_squared_[channel], [&] {
    isolated([&] {
      const double mean = mean_luminance();
      std::vector<double> lights(film_.pixel_count());
      parallel_blocks(lights.size(), 4096, [&](size_t begin, size_t end, size_t) {
        for (size_t i = begin; i < end; ++i) lights[i] = light(i, mean);
      });
      bias_squares_[channel] = bias_->squares(channel, lights, are_pixels_apart());
    });
  });
  return &bias_squares_[channel];
}

double FilmErrors::pixel_bias_sq(size_t pixel, size_t channel) const {
  const FilmBias::Squares* squares = bias_squares(channel);
  return squares ? double(squares->of_pixel[pixel]) : 0;
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

void FilmErrors::prepare_pixels() const {
  for (size_t channel = 0; channel < FilmBias::luminance; ++channel) bias_squares(channel);
  pooled_variance(0);
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
    error[lane] = std::sqrt(variance[lane] + float(pixel_bias_sq(pixel, size_t(lane))));
  return error;
}

ConfidenceInterval KnownLuminance::interval(double confidence) const {
  const double both = std::hypot(deviation, bias_deviation);
  if (!std::isfinite(both) || !std::isfinite(bias))
    return {mean, std::numeric_limits<double>::infinity()};
  return {mean, half_width_with_bias(both, bias, confidence, freedom)};
}

double KnownLuminance::error() const { return std::hypot(deviation, bias); }

KnownLuminance FilmErrors::known(size_t pixel) const {
  const PassCounts& of_pixel = counts(pixel);
  KnownLuminance known;
  known.mean = luminance_sum(pixel) / std::max(1.0, double(of_pixel.count()));
  known.deviation = of_pixel.is_known() ? std::sqrt(pooled_variance(pixel))
                                        : std::numeric_limits<double>::infinity();
  if (const FilmBias::Squares* squares = bias_squares(FilmBias::luminance)) {
    known.bias = std::sqrt(double(squares->of_pixel[pixel]));
    known.bias_deviation = std::sqrt(double(squares->variance[pixel]));
  }
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
  const double mean = mean_luminance();
  const auto sum_of = [&](const auto& square_of) {
    return sum_over_blocks(pixels, 4096, [&](size_t begin, size_t end) {
      double block = 0;
      for (size_t i = begin; i < end; ++i)
        if (const double square = square_of(i); square != 0) block += square / sqr(light(i, mean));
      return block;
    });
  };
  const double noise = sum_of([this](size_t i) { return luminance_variance(i); });
  // Single products may be negative, and some do not make up for noise.
  double bias = 0;
  if (const FilmBias::Squares* squares = bias_squares(FilmBias::luminance))
    bias = std::max(0.0, sum_of([&](size_t i) { return double(squares->around[i]); }));
  return std::sqrt((noise + bias) / double(pixels));
}

double FilmErrors::mean_luminance() const {
  if (parts_.count() > 1)
    return sum_over_blocks(film_.pixel_count(), 4096,
                           [&](size_t begin, size_t end) {
                             double block = 0;
                             for (size_t i = begin; i < end; ++i)
                               block += luminance_sum(i) / std::max(1.0, double(counts(i).count()));
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
