#pragma once
#include <array>
#include <span>
#include <vector>

#include "kaustik/base/bytes.h"
#include "kaustik/transport/block_grid.h"
#include "kaustik/vcm/lessons/training_samples.h"

namespace kaustik {

/// How the camera samples of a pass are spread over blocks of pixels, learned from a few samples
/// of each block in finished passes. All samples of a pass meet the same light paths: what these
/// leave as noise is in no difference between samples of one pixel, nor would more of them take it
/// off, so differences are what is looked at.
class SampleLearning {
 public:
  /// Passes that are learned from: an even and an odd one at least.
  static constexpr uint32_t least_passes = 2, most_passes = 64;

  /// Of pairs of samples, each of one pixel and one pass.
  struct Sums {
    double pairs = 0;
    double squares = 0;          ///< half the squared differences: variances
    double light = 0, rays = 0;  ///< of single samples, means of pairs
    void add(const Sums& other);
  };
  struct BlockSums {
    std::array<Sums, 2> of;  ///< even passes, odd passes: independent
    Sums all() const;
  };

  SampleLearning() = default;
  /// Counts are for the pixels of the crop window.
  /// `is_sparing`: with half of the samples and less, where all that they cost is on top of a plain
  /// path tracer's.
  explicit SampleLearning(const BlockGrid& grid, bool is_sparing = false);

  /// Pairs that a pass is asked for: a few in every block, for that pass alone.
  std::vector<TrainingPlace> places(uint32_t pass) const;
  /// What the pairs at those places add, by block.
  std::vector<Sums> sums_of(std::span<const TrainingPlace> places,
                            std::span<const TrainingPair> pairs) const;
  size_t block_count() const { return sums_.size(); }
  /// What they tell.
  void learn(const std::vector<Sums>& samples, uint32_t pass);
  /// What was learned, and the same back. Reading throws as ByteReader does.
  void write(ByteWriter& writer) const { writer.put_array(sums_); }
  void read(ByteReader& reader) { sums_ = reader.get_array<BlockSums>(sums_.size()); }

  struct Counts {
    std::vector<uint32_t> of_block;  ///< per pixel; empty: all alike
    /// Variance of the samples' mean times rays if all are alike, over that of these counts, as
    /// even passes tell of the counts by the odd ones, and the other way round.
    double gain = 1;
  };
  /// Half of `samples_per_pixel` (at least 1) times powers of two, no more than four times
  /// `samples_per_pixel`, whose mean over the pixels is at most that: by the deviation, relative to
  /// the light around and a tenth of the picture's mean, over the root of the rays. Over how many
  /// blocks the deviations are averaged, and by which power of them counts go, is what leaves least
  /// when even passes choose for the odd ones and the other way round; all alike where nothing is
  /// gained.
  Counts counts(uint32_t samples_per_pixel) const;
  static Counts counts(const std::vector<BlockSums>& sums, const std::vector<uint32_t>& pixels,
                       const Vec2i& blocks, uint32_t samples_per_pixel);

 private:
  BlockGrid grid_;
  bool is_sparing_ = false;
  std::vector<uint32_t> pixels_;  ///< of each block
  std::vector<BlockSums> sums_;
};

}  // namespace kaustik
