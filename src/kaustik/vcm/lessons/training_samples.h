#pragma once
#include <array>
#include <functional>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// Two camera samples of one pixel and pass, to learn from: they are none of the picture's.
struct TrainingPair {
  double variance = 0;  ///< half their squared difference
  double light = 0;     ///< mean
  std::array<uint64_t, 2> rays{};
};

/// Where a pair is taken.
struct TrainingPlace {
  Vec2i picture;       ///< its size
  Vec2i first, block;  ///< of a block of pixels: its first pixel, and how many there are on a side
  uint64_t seed = 0;
  uint64_t number = 0;  ///< of the block, among the picture's
};

/// Takes a sample at a place of the raster.
using TakeSample = std::function<void(const Vec2f& raster, Sampler& sampler, SampleSink& sink)>;

/// Pair number `number` of a block, all of which have random numbers of their own, at its pixel
/// number `pixel`, which stratify one another.
TrainingPair training_pair(const TrainingPlace& place, uint32_t pixel, uint32_t number,
                           const PixelFilter& filter, ComponentSet components,
                           const TakeSample& take);

/// One over the square of the light that the noise of a block counts relative to: the mean over the
/// blocks around as far as `reach`, and a tenth of the picture's mean.
std::vector<double> relative_scale(const std::vector<double>& light, const Vec2i& blocks,
                                   int reach);

}  // namespace kaustik
