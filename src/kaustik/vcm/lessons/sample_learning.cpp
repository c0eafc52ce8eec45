#include "kaustik/vcm/lessons/sample_learning.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kaustik/base/parallel.h"
#include "kaustik/transport/block_means.h"
#include "kaustik/vcm/plan/cost_model.h"
#include "kaustik/vcm/plan/pixel_plans.h"

namespace kaustik {
namespace {

/// Pairs of samples that a block gets in the first passes, which know nothing yet, and later.
constexpr uint32_t first_pairs = 2, later_pairs = 1, first_passes = 4;
constexpr uint32_t pairs_before(uint32_t pass) {
  const uint32_t first = std::min(pass, first_passes);
  return first * first_pairs + (pass - first) * later_pairs;
}
/// Blocks on either side that a block's light and rays are averaged with.
constexpr int light_reach = 1;
/// A block counts as if so many pairs more had the picture's mean variance: those that there are
/// may have seen nothing of what seldom makes others differ.
constexpr double pairs_of_mean = 16;
/// Share of the blocks whose variance counts as that of the next one.
constexpr double outliers = 0.001;
/// Of counts, relative to their mean. Fewer would leave more where light is found by rare chance,
/// which those that are learned from have not seen.
constexpr uint32_t least_divisor = 2;
/// Less is not worth it.
constexpr double worth_spreading = 1.05;

/// How counts are made of variances: averaged over the blocks that far on either side, and their
/// roots taken to that power.
struct Rule {
  int reach;
  double power;
};
constexpr std::array<Rule, 9> rules{
    {{4, 0.5}, {2, 0.5}, {1, 0.5}, {4, 0.75}, {2, 0.75}, {1, 0.75}, {4, 1}, {2, 1}, {1, 1}}};

template <typename Value>
std::vector<double> of_blocks(const std::vector<SampleLearning::Sums>& sums, const Value& value) {
  std::vector<double> result;
  result.reserve(sums.size());
  for (const SampleLearning::Sums& s : sums) result.push_back(s.pairs > 0 ? value(s) / s.pairs : 0);
  return result;
}

/// Of all blocks, relative to the light that they show.
struct Noise {
  double pairs = 0;              ///< of a block
  std::vector<double> variance;  ///< unbiased, but for outliers
};

struct Blocks {
  Vec2i size;
  const std::vector<uint32_t>& pixels;
  std::vector<double> rays;
  std::vector<double> scale;  ///< one over the squared light that noise is relative to
};

Blocks blocks_of(const std::vector<SampleLearning::Sums>& all, const std::vector<uint32_t>& pixels,
                 const Vec2i& size) {
  Blocks result{
      size, pixels,
      means_around(of_blocks(all, [](const auto& s) { return s.rays; }), size, light_reach),
      relative_scale(of_blocks(all, [](const auto& s) { return s.light; }), size, light_reach)};
  for (double& rays : result.rays) rays += cost_model.merging;
  return result;
}

Noise noise_of(const std::vector<SampleLearning::Sums>& sums, const Blocks& blocks) {
  Noise noise{0, of_blocks(sums, [](const auto& s) { return s.squares; })};
  for (size_t i = 0; i < sums.size(); ++i) {
    noise.pairs = std::max(noise.pairs, sums[i].pairs);
    noise.variance[i] *= blocks.scale[i];
  }
  return noise;
}

/// What counts are in proportion to, but for the rays, squared.
std::vector<double> weights_by(const Rule& rule, const Noise& noise, const Blocks& blocks) {
  std::vector<double> result = means_around(noise.variance, blocks.size, rule.reach);
  const double mean = std::accumulate(result.begin(), result.end(), 0.0) / double(result.size());
  const double seen = noise.pairs * double(sqr(2 * rule.reach + 1));
  for (double& value : result) {
    const double shrunk = (value * seen + mean * pairs_of_mean) / (seen + pairs_of_mean);
    value = std::pow(shrunk, rule.power);
  }
  return result;
}

/// Doubles the count of one block after the other, where most variance is taken off per ray.
std::vector<uint32_t> counts_for(const std::vector<double>& weights, const Blocks& blocks,
                                 uint32_t samples) {
  const uint32_t least = std::max(1u, samples / least_divisor),
                 most = samples * SampleSpread::most_factor;
  std::vector<uint32_t> counts(weights.size(), least);
  struct Next {
    double worth;
    size_t block;
    bool operator<(const Next& other) const {
      return worth < other.worth || (worth == other.worth && block > other.block);
    }
  };
  std::vector<Next> heap;
  heap.reserve(counts.size());
  const auto next = [&](size_t i) {
    return Next{weights[i] / (sqr(double(counts[i])) * blocks.rays[i]), i};
  };
  uint64_t left = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    heap.push_back(next(i));
    left += uint64_t(samples - least) * blocks.pixels[i];
  }
  std::make_heap(heap.begin(), heap.end());
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end());
    const size_t i = heap.back().block;
    const uint64_t more = uint64_t(counts[i]) * blocks.pixels[i];
    if (2 * counts[i] > most || more > left) {
      heap.pop_back();
      continue;
    }
    left -= more;
    counts[i] *= 2;
    heap.back() = next(i);
    std::push_heap(heap.begin(), heap.end());
  }
  return counts;
}

/// Variance times rays.
double time_of(const std::vector<double>& variances, const Blocks& blocks,
               const std::vector<uint32_t>& counts) {
  double variance = 0, rays = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    variance += variances[i] / counts[i] * blocks.pixels[i];
    rays += blocks.rays[i] * counts[i] * blocks.pixels[i];
  }
  return variance * rays;
}

}  // namespace

void SampleLearning::Sums::add(const Sums& other) {
  pairs += other.pairs;
  squares += other.squares;
  light += other.light;
  rays += other.rays;
}

SampleLearning::Sums SampleLearning::BlockSums::all() const {
  Sums result = of[0];
  result.add(of[1]);
  return result;
}

SampleLearning::SampleLearning(const BlockGrid& grid, bool is_sparing)
    : grid_(grid), is_sparing_(is_sparing) {
  for (size_t i = 0; i < grid.size(); ++i) pixels_.push_back(uint32_t(grid.crop_pixels(i)));
  sums_.resize(pixels_.size());
}

std::vector<TrainingPlace> SampleLearning::places(uint32_t pass) const {
  const uint32_t pairs = pass < first_passes && !is_sparing_ ? first_pairs : later_pairs;
  // Two passes, an even and an odd one, look at the same blocks, the next two at the others.
  const auto is_left_out = [&](size_t block) {
    if (!is_sparing_ || pass < first_passes) return false;
    const Vec2i at = grid_.block(block);
    return (uint32_t(at.x + at.y) + pass / 2) % 2 == 1;
  };
  std::vector<TrainingPlace> result;
  result.reserve(sums_.size() * pairs);
  // Pixels of one block stratify one another over the passes.
  for (size_t block = 0; block < sums_.size(); ++block)
    for (uint32_t pair = 0; pair < pairs && !is_left_out(block); ++pair)
      result.push_back({uint32_t(block), pairs_before(pass) + pair});
  return result;
}

std::vector<SampleLearning::Sums> SampleLearning::sums_of(
    std::span<const TrainingPlace> places, std::span<const TrainingPair> pairs) const {
  std::vector<Sums> result(sums_.size());
  for (size_t i = 0; i < places.size(); ++i) {
    const TrainingPair& pair = pairs[i];
    result[places[i].block].add(
        {1, pair.variance, pair.light, double(pair.rays[0] + pair.rays[1]) / 2});
  }
  return result;
}

void SampleLearning::learn(const std::vector<Sums>& samples, uint32_t pass) {
  for (size_t i = 0; i < samples.size(); ++i) sums_[i].of[pass % 2].add(samples[i]);
}

SampleLearning::Counts SampleLearning::counts(uint32_t samples_per_pixel) const {
  return counts(sums_, pixels_, grid_.count(), samples_per_pixel);
}

SampleLearning::Counts SampleLearning::counts(const std::vector<BlockSums>& sums,
                                              const std::vector<uint32_t>& pixels,
                                              const Vec2i& size, uint32_t samples_per_pixel) {
  if (sums.empty()) return {};
  std::vector<Sums> all;
  std::array<std::vector<Sums>, 2> halves;
  for (const BlockSums& block : sums) {
    all.push_back(block.all());
    for (size_t h = 0; h < 2; ++h) halves[h].push_back(block.of[h]);
  }
  const Blocks blocks = blocks_of(all, pixels, size);
  const std::array<Noise, 2> noise{noise_of(halves[0], blocks), noise_of(halves[1], blocks)};
  if (!(noise[0].pairs > 0 && noise[1].pairs > 0)) return {};
  std::array<std::vector<double>, 2> truth{noise[0].variance, noise[1].variance};
  for (auto& variances : truth) clip_outliers(variances, outliers);

  const std::vector<uint32_t> even(sums.size(), samples_per_pixel);
  const double before = time_of(truth[0], blocks, even) + time_of(truth[1], blocks, even);
  std::array<double, rules.size()> after{};
  parallel_blocks(rules.size(), 1, [&](size_t r, size_t, size_t) {
    for (size_t half = 0; half < 2; ++half)
      after[r] +=
          time_of(truth[1 - half], blocks,
                  counts_for(weights_by(rules[r], noise[half], blocks), blocks, samples_per_pixel));
  });
  const auto best = size_t(std::min_element(after.begin(), after.end()) - after.begin());
  if (!(after[best] > 0 && before > worth_spreading * after[best])) return {};
  return {
      counts_for(weights_by(rules[best], noise_of(all, blocks), blocks), blocks, samples_per_pixel),
      before / after[best]};
}

}  // namespace kaustik
