#include "kaustik/integrator/connection_learning.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/block_means.h"

namespace kaustik {
namespace {

/// Of the random numbers' addresses.
constexpr uint64_t trial_element = uint64_t(6) << 40;
/// Noise counts relative to the light around, and this share of the picture's mean light.
constexpr double even_share_of_mean = 0.1;
/// A connection is a ray, and finding both densities and what its ends reflect takes as long as so
/// many rays in all.
constexpr double rays_of_connection = 4;
/// Blocks on either side that variances, light and rays are averaged with: few pairs of samples
/// tell little of a single block.
constexpr int reach = 4;
/// Share of the blocks whose variance counts as that of the next one.
constexpr double outliers = 0.001;
/// Less is not worth it.
constexpr double worth_connecting = 1.05;
constexpr int rounds = 6;

using Way = ConnectionLearning::Way;
constexpr size_t ways = ConnectionLearning::way_count;
constexpr size_t pairs = ConnectionLearning::pairs_per_block;
using Trials = std::vector<std::vector<ConnectionLearning::Trial>>;

double all_light(const SampleSink& sink) {
  Spectrum sum;
  for (int c = 0; c < component_count; ++c)
    if (sink.radiance(Component(c)).is_finite()) sum += sink.radiance(Component(c));
  return double(sum.sum());
}

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

Noise noise_of(const Trials& passes, size_t pair, const std::vector<double>& scale) {
  Noise result;
  for (size_t way = 0; way < ways; ++way) {
    for (size_t block = 0; block < scale.size(); ++block) {
      const auto& a = passes[0][block][pair][way];
      const auto& b = passes[1][block][pair][way];
      result.within[way].push_back((a.within + b.within) / 2 * scale[block]);
      result.between[way].push_back(sqr(a.light - b.light) / 2 * scale[block]);
    }
    clip_outliers(result.within[way], outliers);
    clip_outliers(result.between[way], outliers);
  }
  return result;
}

Values rays_of(const Trials& passes, const Vec2i& blocks, double other_rays) {
  Values result;
  for (size_t way = 0; way < ways; ++way) {
    std::vector<double> rays(passes[0].size());
    for (const auto& pass : passes)
      for (size_t block = 0; block < rays.size(); ++block)
        for (size_t pair = 0; pair < pairs; ++pair)
          rays[block] += pass[block][pair][way].rays / double(passes.size() * pairs);
    result[way] = means_around(rays, blocks, reach);
  }
  for (size_t block = 0; block < result[0].size(); ++block) {
    const double more = std::max(0.0, result[Way::connected][block] - result[Way::alone][block]);
    result[Way::alone][block] += other_rays;
    result[Way::connected][block] = result[Way::alone][block] + rays_of_connection * more;
  }
  return result;
}

std::vector<double> scale_of(const Trials& passes, const Vec2i& blocks) {
  std::vector<double> light(passes[0].size());
  for (const auto& pass : passes)
    for (size_t block = 0; block < light.size(); ++block)
      for (const auto& pair : pass[block])
        for (const auto& way : pair)
          light[block] += way.light / double(passes.size() * pairs * ways);
  const double mean = std::accumulate(light.begin(), light.end(), 0.0) / double(light.size());
  std::vector<double> result = means_around(light, blocks, reach);
  for (double& scale : result) {
    const double square = sqr(scale) + sqr(even_share_of_mean * mean);
    scale = square > 0 ? 1 / square : 0;
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
    const PixelFilter& filter, ComponentSet components, const Pass& pass, const TakeSample& take,
    const std::stop_token& stop, uint64_t& rays) const {
  std::vector<Trial> result(size_t(blocks_.x) * size_t(blocks_.y));
  const auto sample_pair = [&](size_t block, uint32_t number, Way way) {
    const Vec2i first =
        Vec2i(int(block % size_t(blocks_.x)), int(block / size_t(blocks_.x))) * block_size_;
    const Vec2i size(std::min(block_size_, picture_.x - first.x),
                     std::min(block_size_, picture_.y - first.y));
    // The same pixel in both passes.
    const Vec2f where =
        Sampler::at(pass.seed, 0, Stream::training, trial_element + block, number).next_2d();
    const Vec2i pixel = first + Vec2i(std::min(int(where.x * float(size.x)), size.x - 1),
                                      std::min(int(where.y * float(size.y)), size.y - 1));
    std::array<double, 2> light{};
    uint64_t pair_rays = 0;
    for (uint32_t i = 0; i < 2; ++i) {
      const uint32_t scramble = 1 + 2 * (pass.index * uint32_t(pairs) + number) + i;
      Sampler sampler =
          Sampler::at(pass.seed, scramble, Stream::training, trial_element + block, 0);
      const Vec2f offset = filter.sample(sampler.next_2d());
      SampleSink sink(components);
      take(way, {float(pixel.x) + 0.5f + offset.x, float(pixel.y) + 0.5f + offset.y}, sampler,
           sink);
      light[i] = all_light(sink);
      pair_rays += sink.rays();
    }
    result[block][number][way] = {0.5 * sqr(light[0] - light[1]), (light[0] + light[1]) / 2,
                                  double(pair_rays) / 2};
    return pair_rays;
  };
  std::atomic<uint64_t> counted{0};
  parallel_blocks(result.size(), 16, [&](size_t begin, size_t end, size_t) {
    uint64_t sum = 0;
    for (size_t block = begin; block < end && !stop.stop_requested(); ++block)
      for (uint32_t pair = 0; pair < pairs; ++pair)
        for (const Way way : {Way::alone, Way::connected}) sum += sample_pair(block, pair, way);
    counted += sum;
  });
  rays += counted;
  return result;
}

ConnectionLearning::Choice ConnectionLearning::choice(uint32_t samples_per_pixel,
                                                      double other_rays) const {
  return choice(trials_, blocks_, samples_per_pixel, other_rays);
}

ConnectionLearning::Choice ConnectionLearning::choice(const std::vector<std::vector<Trial>>& passes,
                                                      const Vec2i& blocks,
                                                      uint32_t samples_per_pixel,
                                                      double other_rays) {
  if (passes.size() != pass_count || passes[0].empty()) return {};
  const std::vector<double> scale = scale_of(passes, blocks);
  const Values rays = rays_of(passes, blocks, other_rays);
  std::array<Noise, pairs> single;
  Noise all;
  for (size_t pair = 0; pair < pairs; ++pair) {
    single[pair] = noise_of(passes, pair, scale);
    all.add(single[pair], 1 / double(pairs));
  }
  const std::vector<bool> nowhere(scale.size(), false);
  double before = 0, after = 0;
  for (size_t pair = 0; pair < pairs; ++pair) {
    const std::vector<bool> by_other = chosen_by(single[1 - pair], rays, blocks, samples_per_pixel);
    before += total_of(single[pair], rays, nowhere, samples_per_pixel).time();
    after += total_of(single[pair], rays, by_other, samples_per_pixel).time();
  }
  if (!(after > 0 && before > worth_connecting * after)) return {};
  Choice result{chosen_by(all, rays, blocks, samples_per_pixel), blocks, 0, before / after};
  result.share = double(std::count(result.connects.begin(), result.connects.end(), true)) /
                 double(scale.size());
  if (result.share == 0) return {};
  return result;
}

}  // namespace kaustik
