#pragma once
#include <array>
#include <functional>
#include <stop_token>
#include <vector>

#include "kaustik/transport/block_grid.h"
#include "kaustik/vcm/lessons/training_samples.h"

namespace kaustik {

/// Where camera paths are worth connecting to light paths, learned from a trial: in four passes,
/// each with its own light paths, a pair of samples of each block of pixels is taken both ways, at
/// the same pixel with the same random numbers. Their differences within a pass tell the noise of
/// camera samples, those between two passes that of light paths as well. None is the picture's.
class ConnectionLearning {
 public:
  /// Passes of the trial, which are one epoch. Two of them choose and the other two judge.
  static constexpr uint32_t first_pass = 4, pass_count = 4;
  static bool tries_in(uint32_t pass) { return pass - first_pass < pass_count; }

  /// Without connections, and with them.
  enum Way : size_t { alone, connected };
  static constexpr size_t way_count = 2;

  /// Of a block in a pass.
  struct Pair {
    double within = 0;           ///< TrainingPair::variance
    double light = 0, rays = 0;  ///< means
  };
  using Trial = std::array<Pair, way_count>;

  ConnectionLearning() = default;
  /// `blocks_per_trial`² blocks of the grid are one of the trial.
  explicit ConnectionLearning(const BlockGrid& grid)
      : grid_(grid.window(), blocks_per_trial * grid.block_size()) {}
  static constexpr int blocks_per_trial = PlanWindow::blocks_together;

  /// Takes a sample of the pass in one of the ways.
  using TakeSampleBy =
      std::function<void(Way way, const Vec2f& raster, Sampler& sampler, SampleSink& sink)>;
  /// Those of one of the passes, for each block. Counts their rays.
  std::vector<Trial> take_samples(const PixelFilter& filter, ComponentSet components,
                                  const Pass& pass, const TakeSampleBy& take,
                                  const std::stop_token& stop, uint64_t& rays) const;
  /// What they tell; pass by pass.
  void learn(const std::vector<Trial>& trial) { trials_.push_back(trial); }

  struct Choice {
    std::vector<bool> connects;  ///< of each block, row by row; empty: none
    Vec2i blocks{0, 0};
    double share = 0;  ///< of the blocks that do
    /// Variance times rays without connections over that of this choice, as passes tell of the
    /// choice that the other ones made.
    double gain = 1;
    /// What is left of the variance with connections everywhere, and how many times as long they
    /// take, in rays.
    double variance_left = 1, time_taken = 1;
  };
  /// For passes with so many samples per pixel, that take `other_rays` per sample beside those of
  /// the camera's paths.
  Choice choice(uint32_t samples_per_pixel, double other_rays) const;
  static Choice choice(const std::vector<std::vector<Trial>>& passes, const Vec2i& blocks,
                       uint32_t samples_per_pixel, double other_rays);

 private:
  BlockGrid grid_;
  std::vector<std::vector<Trial>> trials_;  ///< of each pass
};

}  // namespace kaustik
