#include "kaustik/image/shrinkage.h"

#include <algorithm>

#include "kaustik/base/vectorize.h"

namespace kaustik {
namespace {

/// Three times a mean over so many pixels on either side.
constexpr int pool_reach = 2, pool_times = 3;
/// Pixels that such a mean is worth where they are independent: about 1/Σ of squared weights.
constexpr float pooled_pixels = 75;
/// Standard errors of what a blend gains that are taken off it.
constexpr float gain_errors = 0.5f, gain_errors_by_samples = 2;

/// Of a row, around x: at the picture's edge of what there is.
float mean_around(const float* row, int width, int x) {
  const int begin = std::max(0, x - pool_reach), end = std::min(width, x + pool_reach + 1);
  float sum = 0;
  for (int i = begin; i < end; ++i) sum += row[i];
  return sum / float(end - begin);
}

void mean_in_rows(const Plane& from, int width, int height, Plane& to) {
  parallel_blocks(size_t(height), 16, [&](size_t first, size_t last, size_t) {
    for (size_t y = first; y < last; ++y) {
      const float* row = from.data() + y * size_t(width);
      float* result = to.data() + y * size_t(width);
      const int begin = std::min(pool_reach, width), end = std::max(begin, width - pool_reach);
      for (int x = 0; x < begin; ++x) result[x] = mean_around(row, width, x);
      constexpr float share = 1.0f / (2 * pool_reach + 1);
      KAUSTIK_INDEPENDENT_TURNS
      for (int x = begin; x < end; ++x) {
        float sum = 0;
        for (int i = -pool_reach; i <= pool_reach; ++i) sum += row[x + i];
        result[x] = sum * share;
      }
      for (int x = end; x < width; ++x) result[x] = mean_around(row, width, x);
    }
  });
}

void mean_in_columns(const Plane& from, int width, int height, Plane& to) {
  parallel_blocks(size_t(height), 16, [&](size_t first, size_t last, size_t) {
    for (int y = int(first); y < int(last); ++y) {
      const int begin = std::max(0, y - pool_reach), end = std::min(height, y + pool_reach + 1);
      float* result = to.data() + size_t(y) * size_t(width);
      std::fill(result, result + width, 0.0f);
      for (int i = begin; i < end; ++i) {
        const float* row = from.data() + size_t(i) * size_t(width);
        KAUSTIK_INDEPENDENT_TURNS
        for (int x = 0; x < width; ++x) result[x] += row[x];
      }
      const float inverse = 1 / float(end - begin);
      for (int x = 0; x < width; ++x) result[x] *= inverse;
    }
  });
}

template <typename Value>
Plane pooled(int width, int height, const Value& value) {
  Plane own(size_t(width) * size_t(height)), between(own.size());
  for_pixels(own.size(), [&](size_t i) { own[i] = value(i); });
  for (int time = 0; time < pool_times; ++time) {
    mean_in_rows(own, width, height, between);
    mean_in_columns(between, width, height, own);
  }
  return own;
}

/// Variances by the pixels around alone miss rare events of others, by those that were joined they
/// miss how much of them is here.
Plane larger(Plane a, const Plane& b) {
  for_pixels(a.size(), [&](size_t i) { a[i] = std::max(a[i], b[i]); });
  return a;
}

}  // namespace

Plane share_of_raw(int width, int height, const Blend& blend, const Plane& importance) {
  const auto square = [&](size_t i) { return importance[i] * sqr(blend.change[i]); };
  const auto variance = [&](size_t i) { return importance[i] * blend.own_variance[i]; };
  const Plane squares = pooled(width, height, square);
  const Plane spreads =
      pooled(width, height, [&](size_t i) { return sqr(square(i) - variance(i)); });
  // Changes that rare events of others explain are noise.
  const auto explained = [&](size_t i) {
    return std::min(importance[i] * blend.joined_variance[i], std::max(variance(i), square(i)));
  };
  const Plane noise = larger(pooled(width, height, variance), pooled(width, height, explained));
  // Half of what halves have in common with themselves is told by them, less half of what each has
  // with the other: weights that follow the noise of one half make the other follow it.
  const Plane by_halves =
      pooled(width, height, [&](size_t i) { return importance[i] * blend.covariance[i]; });
  const Plane by_weights =
      pooled(width, height, [&](size_t i) { return importance[i] * blend.filtered_variance[i]; });
  const float errors = blend.knows_halves ? gain_errors : gain_errors_by_samples;
  Plane share(importance.size());
  for_pixels(share.size(), [&](size_t i) {
    const float deviation = std::sqrt(spreads[i] * (1 / pooled_pixels));
    const float common = std::max(by_halves[i], 2 * by_weights[i] - by_halves[i]);
    const float gain = squares[i] - noise[i] + common - errors * deviation;
    share[i] = squares[i] > 0 ? std::clamp(gain / squares[i], 0.0f, 1.0f) : 0.0f;
  });
  return share;
}

Plane error_of_halves(int width, int height, const ChangedHalves& halves, const Plane& odd_share,
                      const Plane& importance) {
  // Of means, by their halves.
  const auto common = [&](size_t i, float off, float also_off) {
    return importance[i] * odd_share[i] * (1 - odd_share[i]) * off * also_off;
  };
  const auto raw_off = [&](size_t i) { return halves.raw[0][i] - halves.raw[1][i]; };
  const auto off = [&](size_t i) { return raw_off(i) + halves.change[0][i] - halves.change[1][i]; };
  const auto change = [&](size_t i) {
    return (1 - odd_share[i]) * halves.change[0][i] + odd_share[i] * halves.change[1][i];
  };
  const Plane variances =
      pooled(width, height, [&](size_t i) { return common(i, off(i), off(i)); });
  const Plane noise =
      pooled(width, height, [&](size_t i) { return common(i, raw_off(i), raw_off(i)); });
  // (Z − X)² less the variance of X, and twice what X and Z have in common.
  const Plane squares = pooled(width, height, [&](size_t i) {
    return importance[i] * sqr(change(i)) - common(i, raw_off(i), raw_off(i)) +
           2 * common(i, raw_off(i), off(i));
  });
  const Plane changes =
      pooled(width, height, [&](size_t i) { return std::sqrt(importance[i]) * change(i); });
  Plane error(importance.size());
  for_pixels(error.size(), [&](size_t i) {
    const float lost = sqr(changes[i]) - noise[i] * (1 / pooled_pixels);
    const float bias = std::max({0.0f, squares[i] - variances[i], lost});
    error[i] = std::sqrt((variances[i] + bias) / importance[i]);
  });
  return error;
}

}  // namespace kaustik
