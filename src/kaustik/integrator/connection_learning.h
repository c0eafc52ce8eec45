#pragma once
#include <array>
#include <functional>
#include <stop_token>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/base/vec.h"
#include "kaustik/integrator/integrator.h"

namespace kaustik {

/// Where camera paths are worth connecting to light paths, learned from a trial: in two passes of
/// their own light paths a few samples of each block of pixels are taken both ways, at the same
/// pixels with the same random numbers. Their differences within a pass tell the noise of camera
/// samples, those between the passes that of light paths as well. They are none of the picture's.
class ConnectionLearning {
 public:
  /// Passes of the trial, which are one epoch.
  static constexpr uint32_t first_pass = 2, pass_count = 2;
  static bool tries_in(uint32_t pass) { return pass - first_pass < pass_count; }

  /// Without connections, and with them.
  enum Way : size_t { alone, connected };
  static constexpr size_t way_count = 2;

  /// Two samples of one pixel in one pass.
  struct Pair {
    double within = 0;           ///< half their squared difference: a variance
    double light = 0, rays = 0;  ///< means
  };
  /// Pairs that stand for one another: what one chooses, the other one judges.
  static constexpr size_t pairs_per_block = 2;
  using Trial = std::array<std::array<Pair, way_count>, pairs_per_block>;

  ConnectionLearning() = default;
  /// Blocks of `block_size`² pixels of a picture.
  ConnectionLearning(const Vec2i& picture, int block_size)
      : picture_(picture),
        blocks_((picture + Vec2i(block_size - 1)) / block_size),
        block_size_(block_size) {}

  /// Takes a sample of the pass at that place of the raster.
  using TakeSample =
      std::function<void(Way way, const Vec2f& raster, Sampler& sampler, SampleSink& sink)>;
  /// Those of one of the passes, for each block. Counts their rays.
  std::vector<Trial> take_samples(const PixelFilter& filter, ComponentSet components,
                                  const Pass& pass, const TakeSample& take,
                                  const std::stop_token& stop, uint64_t& rays) const;
  /// What they tell; pass by pass.
  void learn(const std::vector<Trial>& trial) { trials_.push_back(trial); }

  struct Choice {
    std::vector<bool> connects;  ///< of each block, row by row; empty: none
    Vec2i blocks{0, 0};
    double share = 0;  ///< of the blocks that do
    /// Mean squared error times rays without connections over that of this choice, as pairs tell
    /// of the choice that the other ones made.
    double gain = 1;
  };
  /// For passes with so many samples per pixel, that take `other_rays` per sample beside those of
  /// the camera's paths.
  Choice choice(uint32_t samples_per_pixel, double other_rays) const;
  static Choice choice(const std::vector<std::vector<Trial>>& passes, const Vec2i& blocks,
                       uint32_t samples_per_pixel, double other_rays);

 private:
  Vec2i picture_{0, 0}, blocks_{0, 0};
  int block_size_ = 1;
  std::vector<std::vector<Trial>> trials_;  ///< of each pass
};

}  // namespace kaustik
