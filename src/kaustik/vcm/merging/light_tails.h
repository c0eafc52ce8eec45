#pragma once
#include <span>
#include <stop_token>
#include <vector>

#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// PathWeights::LightTail of all vertices that may be merged, by their numbers in the tree:
/// neighbours in a disk lie side by side, where their paths lie anywhere in memory. Immutable once
/// built.
class LightTails {
 public:
  LightTails() = default;
  /// Worth nothing if it was stopped.
  LightTails(const LightVertices& light, const PathWeights& weights,
             const std::stop_token& stop = {});

  const PathWeights::LightTail& operator[](uint32_t number) const { return tails_[number]; }
  std::span<const PathWeights::LaterMerge> merges(uint32_t number) const {
    const PathWeights::LightTail& tail = tails_[number];
    return std::span(merges_[number / block_size]).subspan(tail.merges, tail.count);
  }

 private:
  static constexpr uint32_t block_size = 4096;
  std::vector<PathWeights::LightTail> tails_;
  std::vector<std::vector<PathWeights::LaterMerge>> merges_;  ///< block by block
};

}  // namespace kaustik
