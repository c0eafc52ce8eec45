// Searching the buckets with vector instructions; compiled once per instruction set, of which
// Highway chooses at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kaustik/photon/kd_tree/kd_tree_search.cpp"
#include <hwy/foreach_target.h>
// Highway asks for this order.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include "kaustik/photon/kd_tree/kd_tree_buckets.h"
#include "kaustik/photon/kd_tree/kd_tree_pack_table.h"

HWY_BEFORE_NAMESPACE();
namespace kaustik::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using PointTag = hn::CappedTag<float, KdBuckets::bucket_size>;
using BoxTag = hn::CappedTag<float, KdBuckets::fan_out>;

/// Stores the lanes of `values` and `ids` that are in `mask`, next to each other; returns how many
/// they are. Whole vectors are written.
template <class D>
HWY_INLINE size_t store_packed(D d, hn::Mask<D> mask, hn::Vec<D> values,
                               hn::Vec<hn::RebindToUnsigned<D>> ids, float* to_values,
                               uint32_t* to_ids) {
  const hn::RebindToUnsigned<D> du;
#if HWY_TARGET == HWY_AVX2
  uint8_t bits[8];
  hn::StoreMaskBits(d, mask, bits);
  const auto shifts = hn::ShiftLeft<2>(hn::Iota(du, 0));
  const auto lanes = hn::And(hn::Shr(hn::Set(du, kd_pack_table[bits[0]]), shifts), hn::Set(du, 7));
  const auto order = hn::IndicesFromVec(d, lanes);
  hn::StoreU(hn::TableLookupLanes(values, order), d, to_values);
  hn::StoreU(hn::TableLookupLanes(ids, hn::IndicesFromVec(du, lanes)), du, to_ids);
#else
  hn::StoreU(hn::Compress(values, mask), d, to_values);
  hn::StoreU(hn::Compress(ids, hn::RebindMask(du, mask)), du, to_ids);
#endif
  return hn::CountTrue(d, mask);
}

/// Number of values below `limit`.
HWY_INLINE size_t count_below(const float* values, size_t count, float limit) {
  const PointTag d;
  const size_t lanes = hn::Lanes(d);
  const auto limits = hn::Set(d, limit);
  size_t below = 0, i = 0;
  for (; i + lanes <= count; i += lanes)
    below += hn::CountTrue(d, hn::Lt(hn::LoadU(d, values + i), limits));
  const auto rest = hn::FirstN(d, count - i);
  return below + hn::CountTrue(d, hn::And(rest, hn::Lt(hn::LoadU(d, values + i), limits)));
}

/// Keeps the candidates below `limit`; returns their number.
HWY_INLINE size_t keep_below(float* distances_sq, uint32_t* indices, size_t count, float limit) {
  const PointTag d;
  const hn::RebindToUnsigned<PointTag> du;
  const auto limits = hn::Set(d, limit);
  size_t kept = 0;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto distances = hn::LoadU(d, distances_sq + i);
    const auto below = hn::And(hn::FirstN(d, count - i), hn::Lt(distances, limits));
    kept += store_packed(d, below, distances, hn::LoadU(du, indices + i), distances_sq + kept,
                         indices + kept);
  }
  return kept;
}

HWY_INLINE void find_range(const float* values, size_t count, float& least, float& greatest) {
  const PointTag d;
  const size_t lanes = hn::Lanes(d);
  auto low = hn::Set(d, values[0]);
  auto high = low;
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto v = hn::LoadU(d, values + i);
    low = hn::Min(low, v);
    high = hn::Max(high, v);
  }
  least = hn::GetLane(hn::MinOfLanes(d, low));
  greatest = hn::GetLane(hn::MaxOfLanes(d, high));
  for (; i < count; ++i) {
    least = HWY_MIN(least, values[i]);
    greatest = HWY_MAX(greatest, values[i]);
  }
}

/// Reduces the candidates to the wanted ones, or to up to `slack` more; returns the bound that
/// this sets: at least `wanted` candidates are at or below it.
///
/// Looks for the limit by interpolation among the counts, as squared distances are spread evenly
/// on a surface; by bisection of the bit patterns every third time, which bounds the effort.
HWY_INLINE float shrink(float* distances_sq, uint32_t* indices, size_t& count, size_t wanted,
                        size_t slack) {
  float least, greatest;
  find_range(distances_sq, count, least, greatest);
  if (count <= wanted + slack) return greatest;
  // The wanted-th value is in [low, high) all the time.
  uint32_t low = std::bit_cast<uint32_t>(least);
  uint32_t high = std::bit_cast<uint32_t>(greatest) + 1;
  size_t below_low = 0, below_high = count;
  for (int i = 0; high - low > 1; ++i) {
    uint32_t middle = low + (high - low) / 2;
    if (i % 3 != 2) {
      const float a = std::bit_cast<float>(low), b = std::bit_cast<float>(high);
      const float share = (float(wanted) + 0.5f + 0.5f * float(slack) - float(below_low)) /
                          float(below_high - below_low);
      const uint32_t guess = std::bit_cast<uint32_t>(a + (b - a) * share);
      middle = HWY_MIN(HWY_MAX(guess, low + 1), high - 1);
    }
    const float limit = std::bit_cast<float>(middle);
    const size_t below = count_below(distances_sq, count, limit);
    if (below >= wanted && below <= wanted + slack) {
      count = keep_below(distances_sq, indices, count, limit);
      return limit;
    }
    (below < wanted ? low : high) = middle;
    (below < wanted ? below_low : below_high) = below;
  }
  // Several are exactly at the bound: keep as many of these as are wanted.
  const float limit = std::bit_cast<float>(low);
  size_t kept = 0, at_limit = wanted - below_low;
  for (size_t i = 0; i < count; ++i) {
    const float distance_sq = distances_sq[i];
    if (distance_sq > limit || (distance_sq == limit && at_limit == 0)) continue;
    if (distance_sq == limit) --at_limit;
    distances_sq[kept] = distance_sq;
    indices[kept++] = indices[i];
  }
  count = kept;
  return limit;
}

size_t SelectNearest(float* distances_sq, uint32_t* indices, size_t count, size_t wanted) {
  if (count > wanted) shrink(distances_sq, indices, count, wanted, 0);
  float least, greatest;
  find_range(distances_sq, count, least, greatest);
  size_t farthest = 0;
  while (distances_sq[farthest] != greatest) ++farthest;
  std::swap(distances_sq[farthest], distances_sq[count - 1]);
  std::swap(indices[farthest], indices[count - 1]);
  return count;
}

struct Entry {
  float distance_sq;
  uint32_t node;  ///< level + 1 (0: a bucket) in the upper four bits, number within it in the rest
};
constexpr uint32_t level_shift = 28;
constexpr size_t stack_size = KdBuckets::max_levels * KdBuckets::fan_out + KdBuckets::fan_out;

/// Squared distances to lanes i… of the children's boxes.
template <class D>
HWY_INLINE hn::Vec<D> box_distance_sq(D d, const KdBuckets::Node& node, size_t i,
                                      const Vec3f& query) {
  const auto excess_sq = [&](int axis) HWY_ATTR {
    const auto q = hn::Set(d, query[axis]);
    const auto below = hn::Sub(hn::Load(d, node.lower[axis] + i), q);
    const auto above = hn::Sub(q, hn::Load(d, node.upper[axis] + i));
    const auto excess = hn::Max(hn::Max(below, above), hn::Zero(d));
    return hn::Mul(excess, excess);
  };
  return hn::Add(hn::Add(excess_sq(0), excess_sq(1)), excess_sq(2));
}

/// Squared distances to lanes i… of a bucket.
template <class D>
HWY_INLINE hn::Vec<D> point_distance_sq(D d, const KdBuckets::Bucket& bucket, size_t i,
                                        const Vec3f& query) {
  const auto x = hn::Sub(hn::Load(d, bucket.x + i), hn::Set(d, query.x));
  const auto y = hn::Sub(hn::Load(d, bucket.y + i), hn::Set(d, query.y));
  const auto z = hn::Sub(hn::Load(d, bucket.z + i), hn::Set(d, query.z));
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

/// Pushes the children of a node that are nearer than `bound`, the nearest last.
HWY_INLINE size_t push_children(const KdBuckets::Node& node, const Vec3f& query, float bound,
                                uint32_t first_child, Entry* stack, size_t top) {
  const BoxTag d;
  const hn::RebindToUnsigned<BoxTag> du;
  float distances[KdBuckets::fan_out + kd_candidate_padding];
  uint32_t children[KdBuckets::fan_out + kd_candidate_padding];
  size_t count = 0;
  for (size_t i = 0; i < KdBuckets::fan_out; i += hn::Lanes(d)) {
    const auto distance = box_distance_sq(d, node, i, query);
    const auto near = hn::Lt(distance, hn::Set(d, bound));
    const auto ids = hn::Iota(du, first_child + uint32_t(i));
    count += store_packed(d, near, distance, ids, distances + count, children + count);
  }
  for (size_t i = 0; i < count; ++i) {
    size_t place = top + i;
    for (; place > top && stack[place - 1].distance_sq < distances[i]; --place)
      stack[place] = stack[place - 1];
    stack[place] = {distances[i], children[i]};
  }
  return top + count;
}

/// Adds the points of a bucket that are nearer than the bound.
template <bool filtered>
HWY_INLINE void test_bucket(const KdBuckets::Bucket& bucket, uint32_t first, const Vec3f& query,
                            const KdBuckets::Filter& filter, KdCandidates& found) {
  const PointTag d;
  const hn::RebindToUnsigned<PointTag> du;
  for (uint32_t i = 0; i < KdBuckets::bucket_size; i += uint32_t(hn::Lanes(d))) {
    const auto distance = point_distance_sq(d, bucket, i, query);
    auto near = hn::Lt(distance, hn::Set(d, found.bound));
    if constexpr (filtered) {
      uint8_t bits[8] = {};
      hn::StoreMaskBits(d, near, bits);
      const uint32_t mask = uint32_t(bits[0]) | uint32_t(bits[1]) << 8;
      if (mask == 0) continue;
      const uint32_t accepted = filter.accept(filter.context, first + i, mask);
      bits[0] = uint8_t(accepted);
      bits[1] = uint8_t(accepted >> 8);
      near = hn::LoadMaskBits(d, bits);
    }
    found.count += store_packed(d, near, distance, hn::Iota(du, first + i),
                                found.distances_sq + found.count, found.indices + found.count);
  }
}

/// Fetches those of the children just pushed that will be looked at first.
HWY_INLINE void prefetch(const KdBuckets::View& view, const Entry* begin, const Entry* end) {
  constexpr ptrdiff_t ahead = 4;
  for (const Entry* entry = end - HWY_MIN(ahead, end - begin); entry < end; ++entry) {
    const uint32_t number = entry->node & ((1u << level_shift) - 1);
    const uint32_t level = entry->node >> level_shift;
    const char* address = level > 0 ? reinterpret_cast<const char*>(&view.levels[level - 1][number])
                                    : reinterpret_cast<const char*>(&view.buckets[number]);
    for (int line = 0; line < 3; ++line) hwy::Prefetch(address + 64 * line);
  }
}

/// Descends into the nearest child first; candidates pile up unsorted, and the bound is found anew
/// when there are many.
template <bool filtered>
void search_nearest(const KdBuckets::View& view, const Vec3f& query,
                    const KdBuckets::Filter& filter, KdCandidates& found) {
  Entry stack[stack_size];
  size_t top = 0;
  stack[top++] = {0.0f, uint32_t(view.level_count) << level_shift};
  // The first bound as soon as there are enough, the later ones once it pays.
  size_t trigger = HWY_MAX(found.wanted, found.count);
  const size_t slack = found.wanted / 8;
  while (top > 0) {
    const Entry entry = stack[--top];
    if (!(entry.distance_sq < found.bound)) continue;
    const uint32_t number = entry.node & ((1u << level_shift) - 1);
    const uint32_t level = entry.node >> level_shift;
    if (level > 0) {
      const uint32_t first_child = number * KdBuckets::fan_out | (level - 1) << level_shift;
      const size_t first = top;
      top = push_children(view.levels[level - 1][number], query, found.bound, first_child, stack,
                          top);
      prefetch(view, stack + first, stack + top);
      continue;
    }
    test_bucket<filtered>(view.buckets[number], number * KdBuckets::bucket_size, query, filter,
                          found);
    if (found.count < trigger) continue;
    found.bound = HWY_MIN(
        found.bound, shrink(found.distances_sq, found.indices, found.count, found.wanted, slack));
    trigger = found.full;
  }
}

void Nearest(const KdBuckets::View& view, const Vec3f& query, const KdBuckets::Filter& filter,
             KdCandidates& found) {
  if (filter.accept != nullptr)
    search_nearest<true>(view, query, filter, found);
  else
    search_nearest<false>(view, query, filter, found);
}

/// The region of KdBuckets::within, for collect().
class Ball {
 public:
  Ball(const Vec3f& center, float radius_sq) : center_(center), radius_sq_(radius_sq) {}

  template <class D>
  HWY_INLINE hn::Mask<D> overlaps(D d, const KdBuckets::Node& node, size_t i) const {
    return hn::Lt(box_distance_sq(d, node, i, center_), hn::Set(d, radius_sq_));
  }
  template <class D>
  HWY_INLINE hn::Mask<D> contains(D d, const KdBuckets::Bucket& bucket, size_t i,
                                  hn::Vec<D>& distance) const {
    distance = point_distance_sq(d, bucket, i, center_);
    return hn::Lt(distance, hn::Set(d, radius_sq_));
  }

 private:
  Vec3f center_;
  float radius_sq_;
};

/// The region of KdBuckets::inside, for collect().
class ClosedBox {
 public:
  ClosedBox(const Vec3f& lower, const Vec3f& upper) : lower_(lower), upper_(upper) {}

  template <class D>
  HWY_INLINE hn::Mask<D> overlaps(D d, const KdBuckets::Node& node, size_t i) const {
    auto result = meets(d, node.lower[0] + i, node.upper[0] + i, 0);
    result = hn::And(result, meets(d, node.lower[1] + i, node.upper[1] + i, 1));
    return hn::And(result, meets(d, node.lower[2] + i, node.upper[2] + i, 2));
  }
  template <class D>
  HWY_INLINE hn::Mask<D> contains(D d, const KdBuckets::Bucket& bucket, size_t i,
                                  hn::Vec<D>& distance) const {
    distance = hn::Zero(d);
    auto result = meets(d, bucket.x + i, bucket.x + i, 0);
    result = hn::And(result, meets(d, bucket.y + i, bucket.y + i, 1));
    return hn::And(result, meets(d, bucket.z + i, bucket.z + i, 2));
  }

 private:
  template <class D>
  HWY_INLINE hn::Mask<D> meets(D d, const float* lower, const float* upper, int axis) const {
    return hn::And(hn::Le(hn::Load(d, lower), hn::Set(d, upper_[axis])),
                   hn::Ge(hn::Load(d, upper), hn::Set(d, lower_[axis])));
  }
  Vec3f lower_, upper_;
};

/// Calls visit(number) for all buckets whose box overlaps the region.
template <typename Region, typename Visit>
HWY_INLINE void visit_buckets(const KdBuckets::View& view, const Region& region,
                              const Visit& visit) {
  const BoxTag box;
  const hn::RebindToUnsigned<BoxTag> box_ids;
  float unused[KdBuckets::fan_out + kd_candidate_padding];
  uint32_t stack[stack_size + kd_candidate_padding];
  size_t top = 0;
  stack[top++] = uint32_t(view.level_count) << level_shift;
  while (top > 0) {
    const uint32_t entry = stack[--top];
    const uint32_t number = entry & ((1u << level_shift) - 1);
    const uint32_t level = entry >> level_shift;
    if (level == 0) {
      visit(number);
      continue;
    }
    const uint32_t first_child = number * KdBuckets::fan_out | (level - 1) << level_shift;
    const KdBuckets::Node& node = view.levels[level - 1][number];
    for (size_t i = 0; i < KdBuckets::fan_out; i += hn::Lanes(box)) {
      const auto overlaps = region.overlaps(box, node, i);
      const auto ids = hn::Iota(box_ids, first_child + uint32_t(i));
      top += store_packed(box, overlaps, hn::Zero(box), ids, unused, stack + top);
    }
  }
}

/// Hands all points of a region to the sink.
template <typename Region>
HWY_INLINE void collect(const KdBuckets::View& view, const Region& region,
                        const KdBuckets::Sink& sink) {
  const PointTag point;
  const hn::RebindToUnsigned<PointTag> point_ids;
  constexpr size_t block = 256;
  float distances_sq[block + kd_candidate_padding];
  uint32_t indices[block + kd_candidate_padding];
  size_t count = 0;
  visit_buckets(view, region, [&](uint32_t number) HWY_ATTR {
    for (uint32_t i = 0; i < KdBuckets::bucket_size; i += uint32_t(hn::Lanes(point))) {
      auto distance = hn::Undefined(point);
      const auto contained = region.contains(point, view.buckets[number], i, distance);
      const auto ids = hn::Iota(point_ids, number * KdBuckets::bucket_size + i);
      count += store_packed(point, contained, distance, ids, distances_sq + count, indices + count);
    }
    if (count < block) return;
    sink.take(sink.context, indices, distances_sq, count);
    count = 0;
  });
  if (count > 0) sink.take(sink.context, indices, distances_sq, count);
}

void Overlapping(const KdBuckets::View& view, const Vec3f& query, float radius_sq,
                 const KdBuckets::BucketSink& sink) {
  constexpr size_t block = 64;
  uint32_t numbers[block];
  size_t count = 0;
  visit_buckets(view, Ball(query, radius_sq), [&](uint32_t number) HWY_ATTR {
    numbers[count++] = number;
    if (count < block) return;
    sink.take(sink.context, numbers, count);
    count = 0;
  });
  if (count > 0) sink.take(sink.context, numbers, count);
}

void Within(const KdBuckets::View& view, const Vec3f& query, float radius_sq,
            const KdBuckets::Sink& sink) {
  collect(view, Ball(query, radius_sq), sink);
}

void Inside(const KdBuckets::View& view, const Vec3f& lower, const Vec3f& upper,
            const KdBuckets::Sink& sink) {
  collect(view, ClosedBox(lower, upper), sink);
}

}  // namespace
}  // namespace kaustik::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kaustik {
namespace {
HWY_EXPORT(SelectNearest);
HWY_EXPORT(Nearest);
HWY_EXPORT(Within);
HWY_EXPORT(Overlapping);
HWY_EXPORT(Inside);
}  // namespace

size_t select_nearest(float* distances_sq, uint32_t* indices, size_t count, size_t wanted) {
  return HWY_DYNAMIC_DISPATCH(SelectNearest)(distances_sq, indices, count, wanted);
}

size_t select_nearest(double* distances_sq, uint32_t* indices, size_t count, size_t wanted) {
  std::vector<std::pair<double, uint32_t>> candidates(count);
  for (size_t i = 0; i < count; ++i) candidates[i] = {distances_sq[i], indices[i]};
  const size_t kept = std::min(count, wanted);
  std::nth_element(candidates.begin(), candidates.begin() + std::ptrdiff_t(kept - 1),
                   candidates.end());
  for (size_t i = 0; i < kept; ++i) std::tie(distances_sq[i], indices[i]) = candidates[i];
  return kept;
}

void KdBuckets::nearest(const Vec3f& query, const Filter& filter,
                        KdNeighbors<float>& neighbors) const {
  if (size_ == 0) return;
  KdCandidates found{neighbors.distances_sq_.data(),
                     neighbors.indices_.data(),
                     neighbors.count_,
                     neighbors.wanted_,
                     neighbors.full_,
                     neighbors.bound_};
  HWY_DYNAMIC_DISPATCH(Nearest)(view(), query, filter, found);
  neighbors.count_ = found.count;
  neighbors.bound_ = found.bound;
}

void KdBuckets::within(const Vec3f& query, float radius_sq, const Sink& sink) const {
  if (size_ == 0) return;
  HWY_DYNAMIC_DISPATCH(Within)(view(), query, radius_sq, sink);
}

void KdBuckets::overlapping(const Vec3f& query, float radius_sq, const BucketSink& sink) const {
  if (size_ == 0) return;
  HWY_DYNAMIC_DISPATCH(Overlapping)(view(), query, radius_sq, sink);
}

void KdBuckets::inside(const Vec3f& lower, const Vec3f& upper, const Sink& sink) const {
  if (size_ == 0) return;
  HWY_DYNAMIC_DISPATCH(Inside)(view(), lower, upper, sink);
}

}  // namespace kaustik
#endif
