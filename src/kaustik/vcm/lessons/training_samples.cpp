#include "kaustik/vcm/lessons/training_samples.h"

#include <algorithm>
#include <numeric>

#include "kaustik/base/parallel.h"
#include "kaustik/transport/block_means.h"

namespace kaustik {
namespace {

/// Noise counts relative to the light around, and this share of the picture's mean light.
constexpr double even_share_of_mean = 0.1;

}  // namespace

TrainingPair training_pair(const TrainingInputs& in, const TrainingPlace& place, Scratch* scratch) {
  const Vec2i first = in.grid.first_pixel(place.block), picture = in.grid.window().size;
  const Vec2i size(std::min(in.grid.block_size(), picture.x - first.x),
                   std::min(in.grid.block_size(), picture.y - first.y));
  const auto numbers = [&](uint32_t element, uint32_t index) {
    return Sampler::at(in.pass.seed, element, Stream::training_pair, place.block, index);
  };
  const Vec2f where = numbers(0, place.number).next_2d();
  const Vec2i pixel = first + Vec2i(std::min(int(where.x * float(size.x)), size.x - 1),
                                    std::min(int(where.y * float(size.y)), size.y - 1));
  TrainingPair result;
  std::array<double, 2> light{};
  for (uint32_t i = 0; i < 2; ++i) {
    // Samples that stratify one another would differ too much, and passes are to be independent.
    Sampler sampler = numbers(1 + 2 * place.number + i, 0);
    const Vec2f offset = in.filter.sample(sampler.next_2d());
    SampleSink sink(in.components, in.pass.wavelengths, scratch);
    in.take({float(pixel.x) + 0.5f + offset.x, float(pixel.y) + 0.5f + offset.y}, sampler, sink);
    light[i] = sink.all_light();
    result.rays[i] = sink.rays();
  }
  result.variance = 0.5 * sqr(light[0] - light[1]);
  result.light = (light[0] + light[1]) / 2;
  return result;
}

std::vector<TrainingPair> training_pairs(const TrainingInputs& in,
                                         std::span<const TrainingPlace> places,
                                         const std::stop_token& stop) {
  std::vector<TrainingPair> result(places.size());
  parallel_blocks(places.size(), 16, [&](size_t begin, size_t end, size_t) {
    Scratch scratch;
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i)
      result[i] = training_pair(in, places[i], &scratch);
  });
  return result;
}

std::vector<double> relative_scale(const std::vector<double>& light, const Vec2i& blocks,
                                   int reach) {
  std::vector<double> result = means_around(light, blocks, reach);
  const double mean = std::accumulate(result.begin(), result.end(), 0.0) / double(result.size());
  for (double& scale : result) {
    const double square = sqr(scale) + sqr(even_share_of_mean * mean);
    scale = square > 0 ? 1 / square : 0;
  }
  return result;
}

}  // namespace kaustik
