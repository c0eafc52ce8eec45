#include "kaustik/render/film_errors.h"

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

/// Pixels on either side that the square of a pixel's bias is averaged with.
constexpr int bias_reach = 2;
/// Share of the picture's mean luminance under which a pixel's own counts less and less.
constexpr double dark_share = 0.01;

using Squares = std::array<float, 4>;

/// Means of each value with its neighbours in a line of `count` values that are `step` apart; at
/// the ends of those that are there.
void smooth_line(const Squares* values, int count, size_t step, Squares* smoothed) {
  for (int i = 0; i < count; ++i) {
    const int first = std::max(0, i - bias_reach), last = std::min(count - 1, i + bias_reach);
    Squares sum{};
    for (int k = first; k <= last; ++k)
      for (size_t c = 0; c < sum.size(); ++c) sum[c] += values[size_t(k) * step][c];
    for (size_t c = 0; c < sum.size(); ++c)
      smoothed[size_t(i) * step][c] = sum[c] / float(last - first + 1);
  }
}

Squares product(const Vec3f& a, const Vec3f& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z, photopic(a) * photopic(b)};
}

}  // namespace

FilmErrors::FilmErrors(const Film& film) : film_(film) {
  for (uint32_t r = 0; r < replicate_count; ++r) {
    replicate_passes_[r] = film.passes().count_of_remainder(r, replicate_count);
    replicates_ += replicate_passes_[r] > 0 ? 1 : 0;
  }
  if (film.holds_bias()) square_bias();
}

void FilmErrors::square_bias() {
  std::array<float, bias_halves> half_passes{};
  for (uint32_t half = 0; half < bias_halves; ++half)
    half_passes[half] = float(film_.passes().count_of_remainder(half, bias_halves));
  if (!(half_passes[0] > 0 && half_passes[1] > 0)) return;
  const int width = film_.width(), height = film_.height();
  std::vector<Squares> rows(film_.pixel_count());
  bias_sq_.resize(film_.pixel_count());
  parallel_blocks(size_t(height), 1, [&](size_t y, size_t, size_t) {
    std::vector<Squares> row(static_cast<size_t>(width));
    for (size_t x = 0; x < row.size(); ++x) {
      const size_t pixel = y * row.size() + x;
      row[x] = product(film_.bias_sum(pixel, 0) / half_passes[0],
                       film_.bias_sum(pixel, 1) / half_passes[1]);
    }
    smooth_line(row.data(), width, 1, rows.data() + y * row.size());
  });
  parallel_blocks(size_t(width), 1, [&](size_t x, size_t, size_t) {
    smooth_line(rows.data() + x, height, size_t(width), bias_sq_.data() + x);
  });
}

double FilmErrors::variance_by_replicates(const Fixed* sums) const {
  double total = 0;
  for (size_t r = 0; r < replicate_count; ++r) total += double_from(sums[r]);
  const double mean = total / passes();
  double squares = 0;
  for (size_t r = 0; r < replicate_count; ++r) {
    squares += sqr(double_from(sums[r]) - replicate_passes_[r] * mean);
  }
  return squares / sqr(passes()) * replicates_ / (replicates_ - 1);
}

double FilmErrors::luminance_sum(size_t pixel) const {
  Fixed sum = 0;
  for (size_t r = 0; r < replicate_count; ++r) add_to(sum, film_.replicate_luminances(pixel)[r]);
  return double_from(sum);
}

double FilmErrors::luminance_variance(size_t pixel) const {
  return is_known() ? variance_by_replicates(film_.replicate_luminances(pixel)) : 0;
}

double FilmErrors::variance_over_passes(double sum, double sum_of_squares) const {
  const double n = passes(), mean = sum / n;
  return std::max(0.0, sum_of_squares / n - mean * mean) / (n - 1);
}

double FilmErrors::bias_luminance_sq(size_t pixel) const {
  return bias_sq_.empty() ? 0 : double(bias_sq_[pixel][3]);
}

Vec3f FilmErrors::of_pixel(size_t pixel) const {
  Vec3f variance(0, 0, 0);
  if (film_.pass_count() >= 2) {
    for (int lane = 0; lane < 3; ++lane)
      variance[lane] =
          float(variance_over_passes(film_.total(pixel, lane), film_.total_squares(pixel, lane)));
    const double luminance_over_passes =
        variance_over_passes(luminance_sum(pixel), film_.luminance_squares(pixel));
    if (is_known() && luminance_over_passes > 0)
      variance *= float(luminance_variance(pixel) / luminance_over_passes);
  }
  Vec3f error;
  for (int lane = 0; lane < 3; ++lane)
    error[lane] = std::sqrt(variance[lane] +
                            (bias_sq_.empty() ? 0 : std::max(0.0f, bias_sq_[pixel][size_t(lane)])));
  return error;
}

ConfidenceInterval FilmErrors::luminance(size_t pixel, double confidence) const {
  const double mean = luminance_sum(pixel) / std::max(1.0, passes());
  if (!is_known()) return {mean, std::numeric_limits<double>::infinity()};
  const double t = student_t_quantile(0.5 + confidence / 2, replicates_ - 1);
  return {mean, t * std::sqrt(luminance_variance(pixel)) +
                    std::sqrt(std::max(0.0, bias_luminance_sq(pixel)))};
}

double FilmErrors::of_picture() const {
  if (!is_known()) return std::numeric_limits<double>::infinity();
  const size_t pixels = film_.pixel_count();
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
  const double bias = sum_of([this](size_t i) { return bias_luminance_sq(i); });
  return std::sqrt((noise + std::max(0.0, bias)) / double(pixels));
}

double FilmErrors::of_mean() const {
  double sum = 0, bias = 0;
  for (const Fixed part : film_.mean_luminances()) sum += double_from(part);
  if (!is_known() || !(sum > 0)) return std::numeric_limits<double>::infinity();
  if (film_.holds_bias())
    for (size_t i = 0; i < film_.pixel_count(); ++i) bias += double(photopic(film_.mean_bias(i)));
  const double t = student_t_quantile(0.975, replicates_ - 1);
  const double noise = std::sqrt(variance_by_replicates(film_.mean_luminances().data()));
  return (t * noise + std::abs(bias) / double(film_.pixel_count())) / (sum / passes());
}

}  // namespace kaustik
