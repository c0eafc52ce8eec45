#include "kaustik/image/cross_filter.h"

#include <algorithm>

#include "kaustik/base/vectorize.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

/// How many pixels apart those are that are averaged. The last ones take out the grid that is left
/// of sparse ones.
constexpr int filter_steps[] = {1, 2, 4, 8, 16, 2, 1};
constexpr int filter_reach = 2;
/// Of the B₃ spline.
constexpr float filter_kernel[5] = {1.0f / 16, 1.0f / 4, 3.0f / 8, 1.0f / 4, 1.0f / 16};
/// From here on means are told apart: |t|².
constexpr float greatest_t_sq = 16;
/// Variances of two pixels above this ratio: the less sure one counts in inverse proportion.
constexpr float greatest_ratio = 64;
/// Of a pixel's variance over that around: rare events.
constexpr float rare_ratio = 8;
/// The variance is a mean over 5 × 5 pixels: that of single pixels is hardly known.
constexpr int variance_reach = 2;
/// Pixels that are compared with their neighbours, too, and what is left of their noise.
constexpr int patch_reach = 1;
constexpr float noise_of_patch = 1.0f / 9;
/// Keeps 0/0 from the test.
constexpr float least_variance = 1e-30f;

/// What decides weights, and what they are applied to.
struct Chain {
  Plane guide, variance;  ///< photopic mean, and its variance
  Plane raw_variance;     ///< of the mean of both halves as it was rendered
  std::array<Plane, 3> light;
  /// Means of guide and variance over 3 × 3 like pixels, in the first round, whose pixels have
  /// noise of their own; else those of the pixel.
  Plane patch, patch_variance;

  void resize(size_t count) {
    guide.resize(count);
    variance.resize(count);
    raw_variance.resize(count);
    for (Plane& plane : light) plane.resize(count);
  }
};

/// Sums of a row of pixels.
struct RowSums {
  explicit RowSums(size_t width) : likeness(width) {
    for (Plane& row : rows) row.resize(width);
  }
  void clear() {
    for (Plane& row : rows) std::fill(row.begin(), row.end(), 0.0f);
  }
  Plane likeness;
  std::array<Plane, 7> rows;  ///< weights, guide, variances, light
};

template <bool has_patches>
void add_neighbor(const Chain& chain, std::ptrdiff_t row, const PixelNeighbor& n, RowSums& sums) {
  const float *here = chain.guide.data() + row, *there = chain.guide.data() + n.row;
  const float *noise_here = chain.variance.data() + row, *noise = chain.variance.data() + n.row;
  const float *r = chain.light[0].data() + n.row, *g = chain.light[1].data() + n.row;
  const float *b = chain.light[2].data() + n.row, *likeness = sums.likeness.data();
  float *weights = sums.rows[0].data(), *guides = sums.rows[1].data();
  float *variances = sums.rows[2].data(), *red = sums.rows[3].data();
  float *green = sums.rows[4].data(), *blue = sums.rows[5].data();
  const float* raw_noise = chain.raw_variance.data() + n.row;
  float* raw_variances = sums.rows[6].data();
  const Plane& patches = has_patches ? chain.patch : chain.guide;
  const Plane& patch_noises = has_patches ? chain.patch_variance : chain.variance;
  const float *patch_here = patches.data() + row, *patch = patches.data() + n.row;
  const float *patch_noise_here = patch_noises.data() + row,
              *patch_noise = patch_noises.data() + n.row;
  KAUSTIK_INDEPENDENT_TURNS
  for (int x = n.begin; x < n.end; ++x) {
    const float difference = here[x] - there[x];
    float t_sq = difference * difference / (noise_here[x] + noise[x] + least_variance);
    if constexpr (has_patches) {
      const float of_patches = patch_here[x] - patch[x];
      t_sq = std::max(
          t_sq, of_patches * of_patches / (patch_noise_here[x] + patch_noise[x] + least_variance));
    }
    const float rest = std::max(0.0f, 1 - t_sq * (1 / greatest_t_sq));
    // Of light that is far less sure than the pixel's own no more than that is worth.
    const float sure = std::min(
        1.0f, greatest_ratio * (noise_here[x] + least_variance) / (noise[x] + least_variance));
    const float w = likeness[x] * rest * rest * sure;
    weights[x] += w;
    guides[x] += w * there[x];
    variances[x] += w * w * noise[x];
    raw_variances[x] += w * raw_noise[x];
    red[x] += w * r[x];
    green[x] += w * g[x];
    blue[x] += w * b[x];
  }
}

void finish_row(const RowSums& sums, size_t row, Chain& result) {
  for (size_t x = 0; x < sums.likeness.size(); ++x) {
    // Zero: values near the end of float's range. They become 0, so nothing is made of them.
    const float inverse = sums.rows[0][x] > 0 ? 1 / sums.rows[0][x] : 0;
    result.guide[row + x] = sums.rows[1][x] * inverse;
    result.variance[row + x] = sums.rows[2][x] * (inverse * inverse);
    result.raw_variance[row + x] = sums.rows[6][x] * inverse;
    for (size_t k = 0; k < 3; ++k) result.light[k][row + x] = sums.rows[3 + k][x] * inverse;
  }
}

/// Averages of like pixels that are `step` apart.
void average(const PixelSurfaces& s, const std::vector<Chain>& chains, int step,
             std::vector<Chain>& result) {
  const auto width = size_t(s.width);
  parallel_blocks(size_t(s.height), 4, [&](size_t first, size_t last, size_t) {
    std::vector<RowSums> sums(chains.size(), RowSums(width));
    for (size_t y = first; y < last; ++y) {
      const size_t row = y * width;
      for (RowSums& of_chain : sums) of_chain.clear();
      for_neighbors(s, int(y), filter_reach, step, [&](const PixelNeighbor& n) {
        if (std::abs(n.dx) + std::abs(n.dy) == 2 * filter_reach) return;  // 1/256 each
        const float share = filter_kernel[n.dx + filter_reach] * filter_kernel[n.dy + filter_reach];
        tell_likeness(s, int(y), n, share, sums[0].likeness.data());
        for (size_t c = 0; c < chains.size(); ++c) {
          if (c > 0) sums[c].likeness.swap(sums[0].likeness);
          if (chains[c].patch.empty())
            add_neighbor<false>(chains[c], std::ptrdiff_t(row), n, sums[c]);
          else
            add_neighbor<true>(chains[c], std::ptrdiff_t(row), n, sums[c]);
          if (c > 0) sums[c].likeness.swap(sums[0].likeness);
        }
      });
      for (size_t c = 0; c < chains.size(); ++c) finish_row(sums[c], row, result[c]);
    }
  });
}

/// Where nothing tells the noise: the variance of the brightness around each pixel, which takes
/// what detail there is for noise.
Plane variance_around(const PixelSurfaces& s, const Plane& brightness) {
  Plane result = brightness;
  for (float& value : result) value *= value;
  result = mean_of_like(s, result, variance_reach);
  const Plane means = mean_of_like(s, brightness, variance_reach);
  for (size_t i = 0; i < result.size(); ++i)
    result[i] = std::max(0.0f, result[i] - means[i] * means[i]);
  return result;
}

/// Of the photopic mean by how much its halves differ, or as it is known without them.
Plane own_variance(const PixelSurfaces& s, const NoisyLight& light, const Plane& mean,
                   const Plane& odd_share) {
  if (!light.has_halves())
    return light.variance.empty() ? variance_around(s, mean) : light.variance;
  Plane variance(mean.size());
  for_pixels(mean.size(), [&](size_t i) {
    const float off = mean[i] * (light.halves[0][i] - light.halves[1][i]);
    variance[i] = off * off * odd_share[i] * (1 - odd_share[i]);
  });
  return variance;
}

/// Both halves may have met a rare event, and agree by chance: where samples tell of far more noise
/// than there is around, they are believed.
void believe_samples(const Plane& by_samples, const Plane& pooled, Plane& own) {
  if (by_samples.empty()) return;
  for_pixels(own.size(), [&](size_t i) {
    if (by_samples[i] > rare_ratio * pooled[i]) own[i] = std::max(own[i], by_samples[i]);
  });
}

std::vector<Chain> chains_of(const PixelSurfaces& s, const NoisyLight& light,
                             const Plane& odd_share) {
  Plane mean(s.pixel_count());
  for_pixels(mean.size(), [&](size_t i) {
    mean[i] = photopic({light.rgb[0][i], light.rgb[1][i], light.rgb[2][i]});
  });
  Plane own = own_variance(s, light, mean, odd_share);
  Plane variance = mean_of_like(s, own, variance_reach);
  believe_samples(light.variance, variance, own);
  // Pooled, but not below what a pixel knows itself: one that a rare event has hit is not taken for
  // another light. Nor far above it, where there is light with far more noise beside it. A pixel
  // without light knows nothing.
  for_pixels(own.size(), [&](size_t i) {
    const float known = light.variance.empty() ? own[i] : std::max(own[i], light.variance[i]);
    if (known > 0) variance[i] = std::max(own[i], std::min(variance[i], greatest_ratio * known));
  });
  if (!light.has_halves())
    return {{std::move(mean), std::move(variance), std::move(own), light.rgb, {}, {}}};
  std::vector<Chain> chains(2);
  for (size_t half = 0; half < 2; ++half) {
    const Plane &of_half = light.halves[half], &of_other = light.halves[1 - half];
    Chain& chain = chains[half];
    chain.resize(mean.size());
    chain.raw_variance = own;
    for_pixels(mean.size(), [&](size_t i) {
      chain.guide[i] = mean[i] * of_half[i];
      chain.variance[i] = variance[i] / (half == 1 ? odd_share[i] : 1 - odd_share[i]);
      for (size_t k = 0; k < 3; ++k) chain.light[k][i] = light.rgb[k][i] * of_other[i];
    });
  }
  return chains;
}

}  // namespace

FilteredLight cross_filtered(const PixelSurfaces& surfaces, const NoisyLight& light,
                             const Plane& odd_share) {
  std::vector<Chain> chains = chains_of(surfaces, light, odd_share);
  std::vector<Chain> next = chains;
  for (Chain& chain : chains) {
    chain.patch = mean_of_like(surfaces, chain.guide, patch_reach);
    chain.patch_variance = mean_of_like(surfaces, chain.variance, patch_reach);
    for (float& value : chain.patch_variance) value *= noise_of_patch;
  }
  for (const int step : filter_steps) {
    average(surfaces, chains, step, next);
    chains.swap(next);
    for (Chain& chain : chains) chain.patch.clear();
  }
  FilteredLight result;
  result.variance = std::move(chains[0].variance);
  result.raw_variance = std::move(chains[0].raw_variance);
  if (light.has_halves())
    for_pixels(result.raw_variance.size(), [&](size_t i) {
      result.variance[i] *= 1 - odd_share[i];
      result.raw_variance[i] = 0.5f * (result.raw_variance[i] + chains[1].raw_variance[i]);
    });
  for (size_t c = 0; c < chains.size(); ++c)
    result.halves[light.has_halves() ? 1 - c : c] = std::move(chains[c].light);
  return result;
}

}  // namespace kaustik
