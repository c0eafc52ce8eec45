#pragma once
#include <array>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/transport/block_grid.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// Two camera samples of one pixel and pass, to learn from: they are none of the picture's.
struct TrainingPair {
  double variance = 0;  ///< half their squared difference
  double light = 0;     ///< mean
  std::array<uint64_t, 2> rays{};
};

/// A pair that somebody asks for: pair number `number` of a block, all of which have random numbers
/// of their own, at its pixel number `number`, which stratify one another.
struct TrainingPlace {
  uint32_t block = 0;  ///< of a grid
  uint32_t number = 0;
};

/// Takes a sample at a place of the raster of the grid's window.
using TakeSample = std::function<void(const Vec2f& raster, Sampler& sampler, SampleSink& sink)>;

/// How pairs are taken.
struct TrainingInputs {
  const BlockGrid& grid;
  const PixelFilter& filter;
  ComponentSet components;
  const Pass& pass;
  const TakeSample& take;
};

/// One pair.
TrainingPair training_pair(const TrainingInputs& in, const TrainingPlace& place,
                           Scratch* scratch = nullptr);
/// Pairs at those places, in their order. Fewer are worth anything if it was stopped.
std::vector<TrainingPair> training_pairs(const TrainingInputs& in,
                                         std::span<const TrainingPlace> places,
                                         const std::stop_token& stop);

/// One over the square of the light that the noise of a block counts relative to: the mean over the
/// blocks around as far as `reach`, and a tenth of the picture's mean.
std::vector<double> relative_scale(const std::vector<double>& light, const Vec2i& blocks,
                                   int reach);

}  // namespace kaustik
