#include "kaustik/vcm/lessons/training_samples.h"

#include <algorithm>
#include <numeric>

#include "kaustik/vcm/lessons/block_means.h"

namespace kaustik {
namespace {

/// Noise counts relative to the light around, and this share of the picture's mean light.
constexpr double even_share_of_mean = 0.1;

double all_light(const SampleSink& sink) {
  Spectrum sum;
  for (int c = 0; c < component_count; ++c)
    if (sink.radiance(Component(c)).is_finite()) sum += sink.radiance(Component(c));
  return double(sum.sum());
}

}  // namespace

TrainingPair training_pair(const TrainingPlace& place, uint32_t pixel_number, uint32_t number,
                           const PixelFilter& filter, ComponentSet components,
                           const TakeSample& take) {
  const Vec2i size(std::min(place.block.x, place.picture.x - place.first.x),
                   std::min(place.block.y, place.picture.y - place.first.y));
  const Vec2f where =
      Sampler::at(place.seed, 0, Stream::training_pair, place.number, pixel_number).next_2d();
  const Vec2i pixel = place.first + Vec2i(std::min(int(where.x * float(size.x)), size.x - 1),
                                          std::min(int(where.y * float(size.y)), size.y - 1));
  TrainingPair result;
  std::array<double, 2> light{};
  for (uint32_t i = 0; i < 2; ++i) {
    // Samples that stratify one another would differ too much, and passes are to be independent.
    Sampler sampler =
        Sampler::at(place.seed, 1 + 2 * number + i, Stream::training_pair, place.number, 0);
    const Vec2f offset = filter.sample(sampler.next_2d());
    SampleSink sink(components);
    take({float(pixel.x) + 0.5f + offset.x, float(pixel.y) + 0.5f + offset.y}, sampler, sink);
    light[i] = all_light(sink);
    result.rays[i] = sink.rays();
  }
  result.variance = 0.5 * sqr(light[0] - light[1]);
  result.light = (light[0] + light[1]) / 2;
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
