#include "kaustik/render/film_bias.h"

#include <algorithm>

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"
#include "kaustik/transport/block_means.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {
namespace {

/// Pixels on either side of a window: wide enough for the disks that auto merges within.
constexpr int window_reach = 11;
/// Of the window that tells how sure a pixel's own estimate is.
constexpr int near_reach = 2;
/// The pixel's own counts where it is larger, and its root more than so many standard errors.
constexpr double least_errors = 3;
/// The share of a smooth bias squared that is told too much.
constexpr double smooth_excess = 1 - sqr(double(smooth_bias_share));

constexpr size_t block_size = 4096;
/// This bounds the memory of intermediate numbers.
constexpr int rows_at_once = 128;

template <typename Value>
std::vector<double> by_pixel(size_t count, const Value& value) {
  std::vector<double> result(count);
  parallel_blocks(count, block_size, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) result[i] = value(i);
  });
  return result;
}

double in_channel(const Vec3f& value, size_t channel) {
  return double(channel == FilmBias::luminance ? photopic(value) : value[int(channel)]);
}

}  // namespace

FilmBias::FilmBias(const Film& film, const FilmParts& parts)
    : parts_(parts),
      size_(film.width(), film.height()),
      sums_(film.pixel_count(), Vec3f(0, 0, 0)),
      halves_(film.pixel_count(), {Vec3f(0, 0, 0), Vec3f(0, 0, 0)}) {
  for (size_t part = 0; part < parts.count(); ++part) is_known_ |= has_halves(parts[part]);
  const PictureTiles& tiles = film.tiles();
  parallel_blocks(tiles.count(), 1, [&](size_t tile, size_t, size_t) {
    std::array<Fixed, PictureTiles::pixels> line;
    for (uint32_t half = 0; half < bias_halves; ++half)
      for (size_t lane = 0; lane < FilmNumbers::lanes; ++lane) {
        film.read(tile, film.numbers().bias + half * FilmNumbers::lanes + lane, line);
        tiles.for_pixels_of(tile, [&](int x, int y, size_t place) {
          const size_t pixel = size_t(y) * size_t(size_.x) + size_t(x);
          const auto sum = float(double_from(line[place]));
          sums_[pixel][int(lane)] += sum;
          const PassCounts& counts = parts.of_pixel(pixel);
          if (has_halves(counts))
            halves_[pixel][half][int(lane)] = sum / float(counts.of_half(half));
        });
      }
  });
}

FilmBias::Squares FilmBias::squares(size_t channel, const std::vector<double>& light,
                                    bool apart) const {
  Squares result;
  result.of_pixel.resize(halves_.size());
  if (channel == luminance)
    for (std::vector<float>* squares : {&result.around, &result.variance})
      squares->resize(halves_.size());
  for (int row = 0; row < size_.y; row += rows_at_once)
    square_rows(channel, light, apart, {row, std::min(size_.y, row + rows_at_once)}, result);
  return result;
}

void FilmBias::square_rows(size_t channel, const std::vector<double>& light, bool apart,
                           const RowRange& rows, Squares& result) const {
  // A mean over a window of means over windows is right in these; at the ends of more rows it is
  // not.
  const int margin = 2 * window_reach;
  const RowRange all_rows{std::max(0, rows.begin - margin), std::min(size_.y, rows.end + margin)};
  const auto width = size_t(size_.x), origin = size_t(all_rows.begin) * width;
  const Vec2i size(size_.x, all_rows.end - all_rows.begin);
  const size_t count = size_t(size.y) * width;
  // Of the pixels of these rows, relative to the light.
  const auto half = [&](size_t i, size_t of) {
    return in_channel(halves_[origin + i][of], channel) / light[origin + i];
  };
  const auto half_difference_sq = [&](size_t i) { return sqr(0.5 * (half(i, 0) - half(i, 1))); };
  const auto weight = [&](size_t i) {
    return has_halves(parts_.of_pixel(origin + i)) ? light[origin + i] : 0;
  };
  const auto around = [&](const std::vector<double>& values, int reach) {
    return apart ? values : means_around(values, size, reach);
  };
  const std::vector<double> weight_around = around(by_pixel(count, weight), window_reach);
  const auto mean_in_window = [&](const auto& value) {
    const std::vector<double> sums =
        around(by_pixel(count, [&](size_t i) { return weight(i) * value(i); }), window_reach);
    return by_pixel(
        count, [&](size_t i) { return weight_around[i] > 0 ? sums[i] / weight_around[i] : 0; });
  };
  const std::vector<double> all = mean_in_window([&](size_t i) { return half(i, 0) * half(i, 1); });
  const std::vector<double> near_variance = around(
      by_pixel(count, [&](size_t i) { return sqr(light[origin + i]) * half_difference_sq(i); }),
      near_reach);
  std::vector<double> common(count), common_variance(count);
  // Alone, a pixel does not tell whether its light bends smoothly.
  if (!apart) {
    const std::vector<double> first = mean_in_window([&](size_t i) { return half(i, 0); });
    const std::vector<double> second = mean_in_window([&](size_t i) { return half(i, 1); });
    common = by_pixel(count, [&](size_t i) {
      return std::clamp(first[i] * second[i], 0.0, std::max(0.0, all[i]));
    });
    if (channel == luminance)
      common_variance = mean_in_window([&](size_t i) { return sqr(0.5 * (first[i] - second[i])); });
  }
  parallel_blocks(
      size_t(rows.end - rows.begin) * width, block_size, [&](size_t begin, size_t end, size_t) {
        for (size_t k = begin; k < end; ++k) {
          const size_t pixel = size_t(rows.begin) * width + k, i = pixel - origin;
          if (!has_halves(parts_.of_pixel(pixel))) continue;
          const double unit = sqr(light[pixel]), c = common[i], v = common_variance[i];
          const double in_window = all[i] - smooth_excess * c;
          const double own = sqr(0.5 * (half(i, 0) + half(i, 1)));
          const double own_variance = std::max(half_difference_sq(i), near_variance[i] / unit);
          const double of_pixel = own > sqr(least_errors) * own_variance
                                      ? std::max(in_window, own - smooth_excess * std::min(own, c))
                                      : in_window;
          result.of_pixel[pixel] = float(std::max(0.0, of_pixel) * unit);
          if (channel != luminance) continue;
          result.around[pixel] = float(in_window * unit);
          if (c > 0) result.variance[pixel] = float((1 - smooth_excess) * v * c / (c + v) * unit);
        }
      });
}

}  // namespace kaustik
