// Building the buckets: points are split at the median of the longest side of their bounds, with
// subtree sizes such that every bucket but the last is full.

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/photon/kd_tree/kd_tree_buckets.h"

namespace kaustik {
namespace {

struct TreePoint {
  float position[3];
  uint32_t source;
};
static_assert(sizeof(TreePoint) == 16);

constexpr size_t parallel_size = 4096;
constexpr size_t parallel_block = 16384;

/// Moves the points for which `belongs` to the front; returns their number. Without branches that
/// depend on the data (after Lomuto): they would be mispredicted half of the time.
template <typename Belongs>
size_t partition_points(TreePoint* points, size_t count, const Belongs& belongs) {
  size_t front = 0;
  for (size_t i = 0; i < count; ++i) {
    const TreePoint point = points[i];
    points[i] = points[front];
    points[front] = point;
    front += belongs(point) ? 1 : 0;
  }
  return front;
}

/// A value near the one of rank `rank`, on the far side of it as seen from the nearer end, so that
/// what remains to be searched is the smaller part (Floyd and Rivest, "Expected time bounds for
/// selection", 1975).
float choose_pivot(const TreePoint* points, size_t count, size_t rank, int axis) {
  constexpr size_t max_samples = 128;
  const size_t samples = count >= 8192 ? max_samples : count >= 1024 ? 32 : 8;
  std::array<float, max_samples> values;
  const size_t stride = count / samples;
  for (size_t i = 0; i < samples; ++i) values[i] = points[i * stride + stride / 2].position[axis];
  const float share = float(rank) / float(count);
  const float deviation = std::sqrt(share * (1.0f - share) * float(samples));
  const float target = share * float(samples) + (share < 0.5f ? deviation : -deviation);
  const size_t chosen = to_integer(target, size_t(0), samples - 1);
  const auto begin = values.begin();
  std::nth_element(begin, begin + std::ptrdiff_t(chosen), begin + std::ptrdiff_t(samples));
  return values[chosen];
}

/// Reorders the points so that none before `rank` is above any from there on.
void select(TreePoint* points, size_t count, size_t rank, int axis) {
  constexpr size_t small = 48;
  // Samples at fixed places can be unlucky again and again: std::nth_element knows a way out.
  for (int attempt = 0; count > small && attempt < 40; ++attempt) {
    const float pivot = choose_pivot(points, count, rank, axis);
    const size_t below = partition_points(
        points, count, [=](const TreePoint& point) { return point.position[axis] < pivot; });
    if (rank < below) {
      count = below;
      continue;
    }
    points += below;
    count -= below;
    rank -= below;
    if (below > 0) continue;
    // The pivot is the least of all: set aside all that equal it, or equal keys would stay forever.
    const size_t equal = partition_points(
        points, count, [=](const TreePoint& point) { return point.position[axis] <= pivot; });
    if (rank < equal) return;
    points += equal;
    count -= equal;
    rank -= equal;
  }
  std::nth_element(
      points, points + rank, points + count,
      [=](const TreePoint& a, const TreePoint& b) { return a.position[axis] < b.position[axis]; });
}

int longest_axis(const TreePoint* points, size_t count) {
  float lower[3] = {infinity, infinity, infinity};
  float upper[3] = {-infinity, -infinity, -infinity};
  for (size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], points[i].position[axis]);
      upper[axis] = std::max(upper[axis], points[i].position[axis]);
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (upper[axis] - lower[axis] > upper[longest] - lower[longest]) longest = axis;
  return longest;
}

/// Orders the points of a node that has (or whose ancestor has) children of `child_size` points.
void split(TreePoint* points, size_t count, size_t child_size, const std::stop_token& stop) {
  if (count <= KdBuckets::bucket_size) return;
  if (count >= parallel_size && stop.stop_requested()) return;
  while (child_size >= count) child_size /= KdBuckets::fan_out;
  const size_t children = (count + child_size - 1) / child_size;
  const size_t left_children = (count + child_size) / (2 * child_size);
  const size_t left = std::clamp<size_t>(left_children, 1, children - 1) * child_size;
  select(points, count, left, longest_axis(points, count));
  const auto split_left = [=, &stop] { split(points, left, child_size, stop); };
  const auto split_right = [=, &stop] { split(points + left, count - left, child_size, stop); };
  if (count < parallel_size) {
    split_left();
    split_right();
  } else {
    in_parallel(split_left, split_right);
  }
}

void fill_bucket(const TreePoint* points, size_t count, KdBuckets::Bucket& bucket) {
  for (size_t i = 0; i < KdBuckets::bucket_size; ++i) {
    bucket.x[i] = i < count ? points[i].position[0] : infinity;
    bucket.y[i] = i < count ? points[i].position[1] : infinity;
    bucket.z[i] = i < count ? points[i].position[2] : infinity;
  }
}

/// An empty box is infinitely far away.
constexpr KdBuckets::Node empty_node() {
  KdBuckets::Node node{};
  for (int axis = 0; axis < 3; ++axis) {
    for (uint32_t child = 0; child < KdBuckets::fan_out; ++child) {
      node.lower[axis][child] = infinity;
      node.upper[axis][child] = -infinity;
    }
  }
  return node;
}

void bound_bucket(const KdBuckets::Bucket& bucket, size_t count, uint32_t child,
                  KdBuckets::Node& node) {
  const float* coordinates[3] = {bucket.x, bucket.y, bucket.z};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [lower, upper] = std::minmax_element(coordinates[axis], coordinates[axis] + count);
    node.lower[axis][child] = *lower;
    node.upper[axis][child] = *upper;
  }
}

void bound_node(const KdBuckets::Node& inner, uint32_t child, KdBuckets::Node& node) {
  for (int axis = 0; axis < 3; ++axis) {
    const float* lower = inner.lower[axis];
    const float* upper = inner.upper[axis];
    node.lower[axis][child] = *std::min_element(lower, lower + KdBuckets::fan_out);
    node.upper[axis][child] = *std::max_element(upper, upper + KdBuckets::fan_out);
  }
}

}  // namespace

std::vector<uint32_t> KdBuckets::build(std::span<const Vec3f> positions,
                                       const std::stop_token& stop) {
  clear();
  size_ = positions.size();
  // Not a vector, whose elements would be set to zero by one thread.
  const auto points = std::make_unique_for_overwrite<TreePoint[]>(size_);
  parallel_blocks(size_, parallel_block, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i)
      points[i] = {{positions[i].x, positions[i].y, positions[i].z}, uint32_t(i)};
  });
  size_t child_size = bucket_size;
  while (child_size < size_) child_size *= fan_out;
  split(points.get(), size_, child_size, stop);
  if (stop.stop_requested()) {
    clear();
    return {};
  }

  std::vector<uint32_t> order(size_);
  std::vector<Bucket>& buckets = buckets_.own();
  buckets.resize(bucket_count_of(size_));
  parallel_blocks(size_, parallel_block, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) order[i] = points[i].source;
    for (size_t i = begin; i < end; i += bucket_size)
      fill_bucket(&points[i], std::min<size_t>(bucket_size, end - i), buckets[i / bucket_size]);
  });
  fill_nodes();
  return order;
}

std::vector<size_t> KdBuckets::level_begins(size_t points) {
  std::vector<size_t> begins{0};
  for (size_t children = bucket_count_of(points);
       children > 0 && (begins.back() == 0 || children > 1);) {
    children = (children + fan_out - 1) / fan_out;
    begins.push_back(begins.back() + children);
  }
  return begins;
}

KdBuckets::Node KdBuckets::node_above(std::span<const Node> children) {
  Node node = empty_node();
  for (size_t child = 0; child < children.size(); ++child)
    bound_node(children[child], uint32_t(child), node);
  return node;
}

KdBuckets KdBuckets::of(size_t size, KeptArray<Bucket> buckets, KeptArray<Node> nodes) {
  KdBuckets tree;
  tree.size_ = size;
  tree.buckets_ = std::move(buckets);
  tree.nodes_ = std::move(nodes);
  tree.level_begin_ = level_begins(size);
  assert(tree.buckets_.size() == bucket_count_of(size));
  assert(tree.nodes_.size() == tree.level_begin_.back());
  return tree;
}

void KdBuckets::fill_nodes() {
  level_begin_ = level_begins(size_);
  std::vector<Node>& nodes = nodes_.own();
  nodes.assign(level_begin_.back(), empty_node());
  const size_t leaves = level_begin_.size() > 1 ? level_begin_[1] : 0;
  parallel_blocks(leaves, parallel_block / bucket_size, [&](size_t begin, size_t end, size_t) {
    for (size_t bucket = begin * fan_out; bucket < std::min(end * fan_out, buckets_.size());
         ++bucket) {
      const size_t count = std::min<size_t>(bucket_size, size_ - bucket * bucket_size);
      bound_bucket(buckets_[bucket], count, bucket % fan_out, nodes[bucket / fan_out]);
    }
  });
  for (size_t level = 1; level + 1 < level_begin_.size(); ++level) {
    const std::span<const Node> below(nodes.data() + level_begin_[level - 1],
                                      level_begin_[level] - level_begin_[level - 1]);
    for (size_t i = level_begin_[level], first = 0; i < level_begin_[level + 1];
         ++i, first += fan_out)
      nodes[i] = node_above(below.subspan(first, std::min<size_t>(fan_out, below.size() - first)));
  }
}

void KdBuckets::remove(uint32_t index) {
  Bucket& bucket = buckets_.own()[index / bucket_size];
  const uint32_t lane = index % bucket_size;
  bucket.x[lane] = bucket.y[lane] = bucket.z[lane] = infinity;
}

KdBuckets::View KdBuckets::view() const {
  View view{buckets_.data(), {}, std::max(int(level_begin_.size()) - 1, 0)};
  for (int level = 0; level < view.level_count; ++level)
    view.levels[level] = nodes_.data() + level_begin_[size_t(level)];
  return view;
}

}  // namespace kaustik
