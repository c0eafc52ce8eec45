#pragma once
// Definitions of kd_tree.h.

#include "kaustik/photon/kd_tree/kd_tree.h"

namespace kaustik {

/// Asks a predicate of either form about up to 32 items.
template <typename Accept>
uint32_t kd_accepted(const Accept& accept, uint32_t first, uint32_t mask) {
  if constexpr (std::is_invocable_v<const Accept&, uint32_t, uint32_t>) {
    return accept(first, mask);
  } else {
    uint32_t result = 0;
    for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      result |= uint32_t(bool(accept(first + uint32_t(bit)))) << bit;
    }
    return result;
  }
}

template <int Dim, typename Key, typename Data, typename Metric>
void KdTree<Dim, Key, Data, Metric>::check(const Key& key) {
  if constexpr (std::is_floating_point_v<KdCoordinate<Key>>) {
    for (int axis = 0; axis < Dim; ++axis) {
      const bool valid =
          has_buckets ? std::fabs(key[axis]) < KdBuckets::max_coordinate : std::isfinite(key[axis]);
      if (!valid) throw Error(ErrorKind::input, "kd-tree: a coordinate is not finite or too large");
    }
  }
}

template <int Dim, typename Key, typename Data, typename Metric>
void KdTree<Dim, Key, Data, Metric>::check_size(size_t size) const {
  if (size > max_size) throw Error(ErrorKind::input, "kd-tree: more than 2^31 items");
}

template <int Dim, typename Key, typename Data, typename Metric>
void KdTree<Dim, Key, Data, Metric>::assign(std::vector<Key> keys, std::vector<Data> data,
                                            const std::stop_token& stop) {
  assert(keys.size() == data.size());
  check_size(keys.size());
  parallel_blocks(keys.size(), 16384, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) check(keys[i]);
  });
  build(std::move(keys), std::move(data), stop);
}

template <int Dim, typename Key, typename Data, typename Metric>
void KdTree<Dim, Key, Data, Metric>::insert(const Key& key, Data data) {
  check(key);
  check_size(data_.size() + 1);
  data_.own().push_back(std::move(data));
  forest_.insert(key, [this](size_t begin, const std::vector<uint32_t>& order) {
    std::vector<Data> moved(order.size());
    const auto first = data_.own().begin() + std::ptrdiff_t(forest_begin() + begin);
    for (size_t i = 0; i < order.size(); ++i) moved[i] = std::move(first[order[i]]);
    std::move(moved.begin(), moved.end(), first);
  });
}

template <int Dim, typename Key, typename Data, typename Metric>
template <typename Accept>
bool KdTree<Dim, Key, Data, Metric>::remove(const Key& key, const Accept& accept) {
  for (const auto& [distance_sq, index] : find(key).hits_) {
    if (kd_accepted(accept, index, 1) == 0) continue;
    remove_at(index);
    return true;
  }
  return false;
}

template <int Dim, typename Key, typename Data, typename Metric>
void KdTree<Dim, Key, Data, Metric>::remove_at(uint32_t index) {
  assert(!removed(index));
  if (index < forest_begin())
    buckets_.remove(index);
  else
    forest_.remove(index - forest_begin());
  ++removed_;
}

template <int Dim, typename Key, typename Data, typename Metric>
bool KdTree<Dim, Key, Data, Metric>::removed(uint32_t index) const {
  return index < forest_begin() ? buckets_.removed(index) : forest_.removed(index - forest_begin());
}

template <int Dim, typename Key, typename Data, typename Metric>
Key KdTree<Dim, Key, Data, Metric>::key(uint32_t index) const {
  if constexpr (has_buckets)
    if (index < forest_begin()) return buckets_.position(index);
  return forest_.key(index - forest_begin());
}

template <int Dim, typename Key, typename Data, typename Metric>
void KdTree<Dim, Key, Data, Metric>::optimise() {
  if (has_buckets && removed_ == 0 && forest_.size() == 0) return;
  std::vector<Key> keys;
  std::vector<Data> data;
  keys.reserve(size());
  data.reserve(size());
  for (uint32_t i = 0; i < data_.size(); ++i) {
    if (removed(i)) continue;
    keys.push_back(key(i));
    data.push_back(std::move(data_.own()[i]));
  }
  build(std::move(keys), std::move(data), {});
}

template <int Dim, typename Key, typename Data, typename Metric>
void KdTree<Dim, Key, Data, Metric>::build(std::vector<Key> keys, std::vector<Data> data,
                                           const std::stop_token& stop) {
  forest_.clear();
  std::vector<uint32_t> order;
  if constexpr (has_buckets)
    order = buckets_.build(keys, stop);
  else
    order = forest_.build(std::move(keys));
  std::vector<Data>& kept = data_.own();
  kept = std::vector<Data>(order.size());
  parallel_blocks(order.size(), 4096, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) kept[i] = std::move(data[order[i]]);
  });
  removed_ = 0;
}

template <int Dim, typename Key, typename Data, typename Metric>
template <typename Visit>
void KdTree<Dim, Key, Data, Metric>::visit_inside(const Key& lower, const Key& upper,
                                                  const Visit& visit) const {
  if constexpr (has_buckets) {
    const auto take = [](void* context, const uint32_t* indices, const float*, size_t count) {
      for (size_t i = 0; i < count; ++i) (*static_cast<const Visit*>(context))(indices[i]);
    };
    buckets_.inside(lower, upper, {take, const_cast<Visit*>(&visit)});
  }
  forest_.inside(lower, upper, [&](uint32_t i) { visit(forest_begin() + i); });
}

template <int Dim, typename Key, typename Data, typename Metric>
auto KdTree<Dim, Key, Data, Metric>::range(const Key& lower, const Key& upper) const -> Matches {
  Matches matches(*this);
  visit_inside(lower, upper, [&](uint32_t index) { matches.hits_.emplace_back(0, index); });
  return matches;
}

template <int Dim, typename Key, typename Data, typename Metric>
template <typename Accept>
void KdTree<Dim, Key, Data, Metric>::nearest(const Key& query, size_t k, Distance limit_sq,
                                             const Accept& accept, Neighbors& neighbors) const {
  neighbors.start(k, limit_sq, size());
  if (k == 0) return;
  forest_.search(
      query, metric_, [&] { return neighbors.bound(); },
      [&](uint32_t i, Distance distance_sq) {
        const uint32_t index = forest_begin() + i;
        if (kd_accepted(accept, index, 1) != 0) neighbors.add(index, distance_sq);
      });
  if constexpr (has_buckets) {
    KdBuckets::Filter filter;
    if constexpr (!std::is_same_v<Accept, KdAcceptAll>) {
      filter.context = &accept;
      filter.accept = [](const void* context, uint32_t first, uint32_t mask) {
        return kd_accepted(*static_cast<const Accept*>(context), first, mask);
      };
    }
    buckets_.nearest(query, filter, neighbors);
  }
  neighbors.finish();
}

template <int Dim, typename Key, typename Data, typename Metric>
template <typename Accept>
auto KdTree<Dim, Key, Data, Metric>::nearest(const Key& query, size_t k, Distance limit_sq,
                                             const Accept& accept) const -> Matches {
  Neighbors neighbors;
  nearest(query, k, limit_sq, accept, neighbors);
  Matches matches(*this);
  matches.hits_.reserve(neighbors.size());
  for (size_t i = 0; i < neighbors.size(); ++i)
    matches.hits_.emplace_back(neighbors.distance_sq(i), neighbors.index(i));
  std::sort(matches.hits_.begin(), matches.hits_.end());
  return matches;
}

template <int Dim, typename Key, typename Data, typename Metric>
template <typename Visit>
void KdTree<Dim, Key, Data, Metric>::within(const Key& query, Distance radius_sq,
                                            const Visit& visit) const {
  if constexpr (has_buckets) {
    const auto take = [](void* context, const uint32_t* indices, const float* distances_sq,
                         size_t count) {
      for (size_t i = 0; i < count; ++i)
        (*static_cast<const Visit*>(context))(indices[i], distances_sq[i]);
    };
    buckets_.within(query, radius_sq, {take, const_cast<Visit*>(&visit)});
  }
  forest_.search(
      query, metric_, [&] { return radius_sq; },
      [&](uint32_t i, Distance distance_sq) { visit(forest_begin() + i, distance_sq); });
}

}  // namespace kaustik
