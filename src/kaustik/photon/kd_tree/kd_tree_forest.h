#pragma once
// The part of a KdTree that serves any dimension, key and metric, and items inserted one by one.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "kaustik/base/parallel.h"

namespace kaustik {

/// Keys are points: key[axis] is a coordinate.
template <typename Key>
using KdCoordinate = std::remove_cvref_t<decltype(std::declval<const Key&>()[0])>;

/// The squared Euclidean distance; the pattern for other metrics. A metric has both members, where
/// axis(d, i) is a lower bound of the distance of keys whose coordinates i differ by d.
template <int Dim, typename Key>
struct EuclideanMetric {
  using Distance = std::conditional_t<std::is_same_v<KdCoordinate<Key>, float>, float, double>;

  Distance operator()(const Key& a, const Key& b) const {
    Distance sum = 0;
    for (int i = 0; i < Dim; ++i) sum += axis(Distance(a[i]) - Distance(b[i]), i);
    return sum;
  }
  Distance axis(Distance difference, int) const { return difference * difference; }
};

/// Keys in one array of consecutive segments, each a balanced tree without pointers: the median
/// stands in the middle, the rest on its two sides. Segments of like size merge when one fills up
/// (Bentley and Saxe, "Decomposable searching problems", 1980), hence any order of insertions
/// costs O(log² n) each; the newest few are searched one by one. Insertions reorder items: all
/// that belongs to a key follows through `Permute`, a callable (begin, order) that puts the item
/// begin + order[i] at begin + i.
template <int Dim, typename Key, typename Metric>
class KdForest {
 public:
  using Distance = typename Metric::Distance;

  size_t size() const { return keys_.size(); }
  const Key& key(uint32_t i) const { return keys_[i]; }
  bool removed(uint32_t i) const { return removed_[i] != 0; }
  void remove(uint32_t i) { removed_[i] = 1; }
  void clear() { *this = {}; }
  size_t size_in_bytes() const {
    return keys_.capacity() * sizeof(Key) + removed_.capacity() +
           segment_ends_.capacity() * sizeof(uint32_t);
  }

  template <typename Permute>
  void insert(const Key& key, const Permute& permute) {
    keys_.push_back(key);
    removed_.push_back(0);
    if (keys_.size() - unsorted_begin() < leaf_size * 4) return;
    segment_ends_.push_back(uint32_t(keys_.size()));
    while (segment_ends_.size() > 1 && segment_size(1) >= segment_size(2))
      segment_ends_.erase(segment_ends_.end() - 2);
    const size_t last = segment_ends_.size() - 1;
    sort_segment(last > 0 ? segment_ends_[last - 1] : 0, segment_ends_[last], permute);
  }

  /// Replaces everything by one balanced tree; returns the order of the keys.
  std::vector<uint32_t> build(std::vector<Key> keys) {
    clear();
    keys_ = std::move(keys);
    removed_.assign(keys_.size(), 0);
    std::vector<uint32_t> result;
    if (keys_.empty()) return result;
    segment_ends_.push_back(uint32_t(keys_.size()));
    sort_segment(0, keys_.size(),
                 [&](size_t, std::vector<uint32_t>& order) { result = std::move(order); });
    return result;
  }

  /// Calls visit(i, distance) for the items with distance < bound(), which may shrink meanwhile.
  template <typename Bound, typename Visit>
  void search(const Key& query, const Metric& metric, const Bound& bound,
              const Visit& visit) const {
    const Search<Bound, Visit> task{*this, query, metric, bound, visit};
    size_t begin = 0;
    for (uint32_t end : segment_ends_) {
      task.visit_range(begin, end, 0);
      begin = end;
    }
    task.visit_all(begin, keys_.size());
  }

  /// Calls visit(i) for the items in the closed box.
  template <typename Visit>
  void inside(const Key& lower, const Key& upper, const Visit& visit) const {
    size_t begin = 0;
    for (uint32_t end : segment_ends_) {
      visit_inside(begin, end, 0, lower, upper, visit);
      begin = end;
    }
    for (; begin < keys_.size(); ++begin) test_inside(begin, lower, upper, visit);
  }

 private:
  static constexpr size_t leaf_size = 8;
  static constexpr size_t parallel_size = 4096;

  size_t unsorted_begin() const { return segment_ends_.empty() ? 0 : segment_ends_.back(); }
  /// Size of the i-th segment from the end.
  size_t segment_size(size_t i) const {
    const size_t n = segment_ends_.size();
    return segment_ends_[n - i] - (n > i ? segment_ends_[n - i - 1] : 0);
  }

  template <typename Permute>
  void sort_segment(size_t begin, size_t end, const Permute& permute) {
    std::vector<uint32_t> order(end - begin);
    std::iota(order.begin(), order.end(), 0u);
    sort_range(keys_.data() + begin, order.data(), order.data() + order.size(), 0);
    std::vector<Key> keys(order.size());
    std::vector<uint8_t> removed(order.size());
    for (size_t i = 0; i < order.size(); ++i) {
      keys[i] = keys_[begin + order[i]];
      removed[i] = removed_[begin + order[i]];
    }
    std::copy(keys.begin(), keys.end(), keys_.begin() + std::ptrdiff_t(begin));
    std::copy(removed.begin(), removed.end(), removed_.begin() + std::ptrdiff_t(begin));
    permute(begin, order);
  }

  static void sort_range(const Key* keys, uint32_t* begin, uint32_t* end, int axis) {
    const size_t count = size_t(end - begin);
    if (count <= leaf_size) return;
    uint32_t* const middle = begin + count / 2;
    std::nth_element(begin, middle, end,
                     [=](uint32_t a, uint32_t b) { return keys[a][axis] < keys[b][axis]; });
    const int next = (axis + 1) % Dim;
    const auto lower = [=] { sort_range(keys, begin, middle, next); };
    const auto upper = [=] { sort_range(keys, middle + 1, end, next); };
    if (count < parallel_size) {
      lower();
      upper();
    } else {
      in_parallel(lower, upper);
    }
  }

  template <typename Bound, typename Visit>
  struct Search {
    const KdForest& forest;
    const Key& query;
    const Metric& metric;
    const Bound& bound;
    const Visit& visit;

    void visit_one(size_t i) const {
      if (forest.removed_[i]) return;
      const Distance distance = metric(query, forest.keys_[i]);
      if (distance < bound()) visit(uint32_t(i), distance);
    }
    void visit_all(size_t begin, size_t end) const {
      for (; begin < end; ++begin) visit_one(begin);
    }
    void visit_range(size_t begin, size_t end, int axis) const {
      if (end - begin <= leaf_size) return visit_all(begin, end);
      const size_t middle = begin + (end - begin) / 2;
      const Distance offset = Distance(query[axis]) - Distance(forest.keys_[middle][axis]);
      const int next = (axis + 1) % Dim;
      const bool below = offset < 0;
      below ? visit_range(begin, middle, next) : visit_range(middle + 1, end, next);
      if (!(metric.axis(offset, axis) < bound())) return;
      visit_one(middle);
      below ? visit_range(middle + 1, end, next) : visit_range(begin, middle, next);
    }
  };

  template <typename Visit>
  void test_inside(size_t i, const Key& lower, const Key& upper, const Visit& visit) const {
    if (removed_[i]) return;
    for (int axis = 0; axis < Dim; ++axis)
      if (keys_[i][axis] < lower[axis] || keys_[i][axis] > upper[axis]) return;
    visit(uint32_t(i));
  }
  template <typename Visit>
  void visit_inside(size_t begin, size_t end, int axis, const Key& lower, const Key& upper,
                    const Visit& visit) const {
    if (end - begin <= leaf_size) {
      for (; begin < end; ++begin) test_inside(begin, lower, upper, visit);
      return;
    }
    const size_t middle = begin + (end - begin) / 2;
    const auto split = keys_[middle][axis];
    const int next = (axis + 1) % Dim;
    if (!(split < lower[axis])) visit_inside(begin, middle, next, lower, upper, visit);
    test_inside(middle, lower, upper, visit);
    if (!(split > upper[axis])) visit_inside(middle + 1, end, next, lower, upper, visit);
  }

  std::vector<Key> keys_;
  std::vector<uint8_t> removed_;
  std::vector<uint32_t> segment_ends_;
};

}  // namespace kaustik
