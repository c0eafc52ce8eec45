#include "kaustik/vcm/lessons/connection_learning.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/vcm/lessons/block_means.h"

namespace kaustik {
namespace {

/// Of the random numbers' addresses.
constexpr uint64_t trial_element = uint64_t(6) << 40;
/// A connection that is traced takes as long as so many rays, with both densities and what its ends
/// reflect; those that are tried in vain, and light paths that are kept for them, as so many more
/// per sample. Between the times that `ppm` takes without connections and with them, of scenes with
/// few and with many of them.
constexpr double rays_of_connection = 3, rays_of_trying = 4;
/// Blocks on either side that variances, light and rays are averaged with: single pairs of samples
/// tell little.
constexpr int reach = 4;
/// Share of the blocks whose variance counts as that of the next one.
constexpr double outliers = 0.001;
/// Less is not worth it.
constexpr double worth_connecting = 1.1;
constexpr int rounds = 6;

using Way = ConnectionLearning::Way;
using PassTrials = std::vector<ConnectionLearning::Trial>;  ///< of each block
constexpr size_t ways = ConnectionLearning::way_count;
constexpr size_t halves = 2;
/// Of a half of the trial.
constexpr size_t passes_per_half = 2;
static_assert(halves * passes_per_half == ConnectionLearning::pass_count);

/// Of each block, by way.
using Values = std::array<std::vector<double>, ways>;

/// Variances relative to the light around: of one sample for given light paths, and of the mean of
/// two samples with light paths of their own.
struct Noise {
  Values within, between;

  void add(const Noise& other, double weight);
  Noise smoothed(const Vec2i& blocks) const;
  /// Of a pixel in a pass, whose samples share what light paths leave.
  static double of_pass(double within, double between, uint32_t samples) {
    return within / double(samples) + std::max(0.0, between - within / 2);
  }
};

void Noise::add(const Noise& other, double weight) {
  for (size_t way = 0; way < ways; ++way) {
    within[way].resize(other.within[way].size());
    between[way].resize(other.between[way].size());
    for (size_t block = 0; block < within[way].size(); ++block) {
      within[way][block] += weight * other.within[way][block];
      between[way][block] += weight * other.between[way][block];
    }
  }
}

Noise Noise::smoothed(const Vec2i& blocks) const {
  Noise result;
  for (size_t way = 0; way < ways; ++way) {
    result.within[way] = means_around(within[way], blocks, reach);
    result.between[way] = means_around(between[way], blocks, reach);
  }
  return result;
}

/// Of two passes.
Noise noise_of(const PassTrials& first, const PassTrials& second,
               const std::vector<double>& scale) {
  Noise result;
  for (size_t way = 0; way < ways; ++way) {
    for (size_t block = 0; block < scale.size(); ++block) {
      const auto &a = first[block][way], &b = second[block][way];
      result.within[way].push_back((a.within + b.within) / 2 * scale[block]);
      result.between[way].push_back(sqr(a.light - b.light) / 2 * scale[block]);
    }
    clip_outliers(result.within[way], outliers);
    clip_outliers(result.between[way], outliers);
  }
  return result;
}

/// Means over passes of each block.
template <typename Value>
std::vector<double> mean_over(const std::vector<PassTrials>& passes, const Value& value) {
  std::vector<double> result(passes[0].size());
  for (const PassTrials& pass : passes)
    for (size_t block = 0; block < result.size(); ++block)
      result[block] += value(pass[block]) / double(passes.size());
  return result;
}

Values rays_of(const std::vector<PassTrials>& passes, const Vec2i& blocks, double other_rays) {
  Values result;
  for (const Way way : {Way::alone, Way::connected})
    result[way] = means_around(
        mean_over(passes, [&](const auto& trial) { return trial[way].rays; }), blocks, reach);
  for (size_t block = 0; block < result[0].size(); ++block) {
    const double more = std::max(0.0, result[Way::connected][block] - result[Way::alone][block]);
    result[Way::alone][block] += other_rays;
    result[Way::connected][block] =
        result[Way::alone][block] + rays_of_trying + rays_of_connection * more;
  }
  return result;
}

struct Total {
  double variance = 0, rays = 0;
  double time() const { return variance * rays; }
};
Total total_of(const Noise& noise, const Values& rays, const std::vector<bool>& connects,
               uint32_t samples) {
  double within = 0, between = 0;
  Total total;
  for (size_t block = 0; block < connects.size(); ++block) {
    const size_t way = connects[block] ? Way::connected : Way::alone;
    within += noise.within[way][block];
    between += noise.between[way][block];
    total.rays += rays[way][block];
  }
  // Of a single block the light paths' part may come out negative; that is bounded for the sum.
  total.variance = Noise::of_pass(within, between, samples);
  return total;
}

/// The least product of two sums is the least weighted sum for weights that are found by turns.
std::vector<bool> chosen_by(const Noise& single, const Values& rays, const Vec2i& blocks,
                            uint32_t samples) {
  const Noise noise = single.smoothed(blocks);
  std::vector<bool> connects(rays[0].size(), false);
  for (int round = 0; round < rounds; ++round) {
    const Total total = total_of(noise, rays, connects, samples);
    for (size_t block = 0; block < connects.size(); ++block) {
      const auto time = [&](Way way) {
        return Noise::of_pass(noise.within[way][block], noise.between[way][block], samples) *
                   total.rays +
               rays[way][block] * total.variance;
      };
      connects[block] = time(Way::connected) < time(Way::alone);
    }
  }
  return connects;
}

}  // namespace

std::vector<ConnectionLearning::Trial> ConnectionLearning::take_samples(
    const PixelFilter& filter, ComponentSet components, const Pass& pass, const TakeSampleBy& take,
    const std::stop_token& stop, uint64_t& rays) const {
  PassTrials result(grid_.size());
  std::atomic<uint64_t> counted{0};
  parallel_blocks(result.size(), 16, [&](size_t begin, size_t end, size_t) {
    uint64_t sum = 0;
    for (size_t block = begin; block < end && !stop.stop_requested(); ++block) {
      const Vec2i first = grid_.first_pixel(block);
      for (const Way way : {Way::alone, Way::connected}) {
        // The same pixel in both passes of a half.
        const TrainingPair pair =
            training_pair({grid_.window().size, first, Vec2i(grid_.block_size()), pass.seed,
                           trial_element + block},
                          (pass.index - first_pass) / uint32_t(passes_per_half), pass.index, filter,
                          components, [&](const Vec2f& raster, Sampler& sampler, SampleSink& sink) {
                            take(way, raster, sampler, sink);
                          });
        const uint64_t pair_rays = pair.rays[0] + pair.rays[1];
        result[block][way] = {pair.variance, pair.light, double(pair_rays) / 2};
        sum += pair_rays;
      }
    }
    counted += sum;
  });
  rays += counted;
  return result;
}

ConnectionLearning::Choice ConnectionLearning::choice(uint32_t samples_per_pixel,
                                                      double other_rays) const {
  return choice(trials_, grid_.count(), samples_per_pixel, other_rays);
}

ConnectionLearning::Choice ConnectionLearning::choice(const std::vector<PassTrials>& passes,
                                                      const Vec2i& blocks,
                                                      uint32_t samples_per_pixel,
                                                      double other_rays) {
  Choice result;
  result.blocks = blocks;
  if (passes.size() != pass_count || passes[0].empty()) return result;
  const std::vector<double> scale = relative_scale(
      mean_over(
          passes,
          [](const Trial& trial) { return (trial[alone].light + trial[connected].light) / 2; }),
      blocks, reach);
  const Values rays = rays_of(passes, blocks, other_rays);
  std::array<Noise, halves> of_half;
  Noise all;
  for (size_t half = 0; half < halves; ++half) {
    of_half[half] =
        noise_of(passes[half * passes_per_half], passes[half * passes_per_half + 1], scale);
    all.add(of_half[half], 1 / double(halves));
  }
  const std::vector<bool> nowhere(scale.size(), false), everywhere(scale.size(), true);
  const Total without = total_of(all, rays, nowhere, samples_per_pixel);
  const Total with = total_of(all, rays, everywhere, samples_per_pixel);
  if (without.variance > 0) result.variance_left = with.variance / without.variance;
  result.time_taken = with.rays / without.rays;
  double before = 0, after = 0;
  for (size_t half = 0; half < halves; ++half) {
    const std::vector<bool> by_other =
        chosen_by(of_half[1 - half], rays, blocks, samples_per_pixel);
    before += total_of(of_half[half], rays, nowhere, samples_per_pixel).time();
    after += total_of(of_half[half], rays, by_other, samples_per_pixel).time();
  }
  if (!(after > 0 && before > worth_connecting * after)) return result;
  const std::vector<bool> connects = chosen_by(all, rays, blocks, samples_per_pixel);
  const auto count = std::count(connects.begin(), connects.end(), true);
  if (count == 0) return result;
  result.connects = connects;
  result.share = double(count) / double(scale.size());
  result.gain = before / after;
  return result;
}

}  // namespace kaustik
