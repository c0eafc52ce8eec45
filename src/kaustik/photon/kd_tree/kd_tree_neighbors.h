#pragma once
// What a search for the k nearest neighbours collects.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace kaustik {

/// Reduces `count` > 0 candidates to the `wanted` > 0 nearest, if there are more, and puts the
/// farthest of these last; returns how many they are. Of candidates at the same distance any may
/// stay. Both arrays must have room for `kd_candidate_padding` more elements.
size_t select_nearest(float* distances_sq, uint32_t* indices, size_t count, size_t wanted);
size_t select_nearest(double* distances_sq, uint32_t* indices, size_t count, size_t wanted);

inline constexpr size_t kd_candidate_padding = 32;

/// The result of one search and its working memory: keep one per thread and use it again and
/// again. The neighbours are in no particular order, except that the farthest is the last one.
template <typename Distance>
class KdNeighbors {
 public:
  static constexpr Distance unlimited = std::numeric_limits<Distance>::infinity();

  size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  /// As many as were asked for were found within the limit.
  bool complete() const { return count_ == wanted_; }
  /// Index of the i-th neighbour in the tree's order: KdTree::data(index).
  uint32_t index(size_t i) const { return indices_[i]; }
  Distance distance_sq(size_t i) const { return distances_sq_[i]; }
  std::span<const uint32_t> indices() const { return {indices_.data(), count_}; }
  std::span<const Distance> distances_sq() const { return {distances_sq_.data(), count_}; }
  /// Squared distance of the farthest neighbour, which is the last one; 0 if there are none.
  Distance farthest_sq() const { return count_ > 0 ? distances_sq_[count_ - 1] : Distance(0); }

  /// Starts a search for the `wanted` nearest with distance_sq < limit_sq among `available` items.
  void start(size_t wanted, Distance limit_sq, size_t available) {
    wanted_ = wanted;
    bound_ = limit_sq;
    count_ = 0;
    const size_t kept = std::min(wanted, available);
    full_ = kept + std::max<size_t>(16, kept / 2);
    if (indices_.size() >= full_ + kd_candidate_padding) return;
    indices_.resize(full_ + kd_candidate_padding);
    distances_sq_.resize(full_ + kd_candidate_padding);
  }
  /// Candidates at this squared distance or farther need not be added.
  Distance bound() const { return bound_; }
  void add(uint32_t index, Distance distance_sq) {
    indices_[count_] = index;
    distances_sq_[count_++] = distance_sq;
    if (count_ >= full_) shrink();
  }
  /// Leaves only the wanted ones.
  void finish() {
    if (count_ > 0) shrink();
  }
  /// Puts them in the order of their distances, those at the same distance in that of the tree.
  void sort() {
    std::vector<std::pair<Distance, uint32_t>> all;
    all.reserve(count_);
    for (size_t i = 0; i < count_; ++i) all.emplace_back(distances_sq_[i], indices_[i]);
    std::sort(all.begin(), all.end());
    for (size_t i = 0; i < count_; ++i) std::tie(distances_sq_[i], indices_[i]) = all[i];
  }

 private:
  friend class KdBuckets;

  void shrink() {
    count_ = select_nearest(distances_sq_.data(), indices_.data(), count_, wanted_);
    if (count_ == wanted_) bound_ = distances_sq_[count_ - 1];
  }

  std::vector<Distance> distances_sq_;
  std::vector<uint32_t> indices_;
  size_t count_ = 0;
  size_t wanted_ = 0;
  size_t full_ = 0;  ///< number of candidates at which they are reduced to the wanted ones
  Distance bound_ = unlimited;
};

}  // namespace kaustik
