#pragma once
// The optimised part of a KdTree of three-dimensional float positions: a static tree of buckets.

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "kaustik/base/kept_array.h"
#include "kaustik/base/vec.h"
#include "kaustik/photon/kd_tree/kd_tree_neighbors.h"

namespace kaustik {

/// The candidates of a search under way, in the memory of a KdNeighbors.
struct KdCandidates {
  float* distances_sq;
  uint32_t* indices;
  size_t count;
  size_t wanted;
  size_t full;
  float bound;
};

/// A balanced tree whose leaves are buckets of 16 points, searched with the vector instructions of
/// the machine. Every bucket but the last is full, and each inner node holds the boxes of its 8
/// children; where these are follows from their number, so that there are no pointers: 1.7 bytes
/// per point beside the positions.
class KdBuckets {
 public:
  static constexpr uint32_t bucket_size = 16;
  static constexpr uint32_t fan_out = 8;
  static constexpr int max_levels = 10;  ///< enough for 2^31 points
  /// Coordinates must be smaller, or squared distances would not be finite.
  static constexpr float max_coordinate = 1e18f;

  struct alignas(64) Bucket {
    float x[bucket_size], y[bucket_size], z[bucket_size];
  };
  struct alignas(64) Node {
    float lower[3][fan_out], upper[3][fan_out];
  };
  /// What the vector code sees of the tree. Child c of node i of level l is node fan_out * i + c
  /// of level l - 1; on level 0 it is a bucket. The top level has one node.
  struct View {
    const Bucket* buckets;
    const Node* levels[max_levels];
    int level_count;
  };

  /// Decides about several points at once: bit i of `mask` stands for point `first + i`; returns
  /// the mask of those that count.
  struct Filter {
    uint32_t (*accept)(const void* context, uint32_t first, uint32_t mask) = nullptr;
    const void* context = nullptr;
  };
  /// Gets the points found, a block at a time.
  struct Sink {
    void (*take)(void* context, const uint32_t* indices, const float* distances_sq, size_t count);
    void* context;
  };

  /// Gets numbers of buckets, a block at a time.
  struct BucketSink {
    void (*take)(void* context, const uint32_t* numbers, size_t count);
    void* context;
  };

  /// Builds the tree in parallel; the result does not depend on the number of threads. All
  /// coordinates are below max_coordinate. Returns the order of the points: point i of the tree is
  /// positions[order[i]]. Where `stop` is requested the tree is left empty.
  std::vector<uint32_t> build(std::span<const Vec3f> positions, const std::stop_token& stop = {});
  void clear() { *this = {}; }
  /// A tree of so many points that was built before: its buckets, and the nodes of all levels, the
  /// lowest first.
  static KdBuckets of(size_t size, KeptArray<Bucket> buckets, KeptArray<Node> nodes);
  /// Of a tree of so many points.
  static constexpr size_t bucket_count_of(size_t points) {
    return (points + bucket_size - 1) / bucket_size;
  }
  /// Where the nodes of each level begin in a tree of so many points, and how many there are.
  static std::vector<size_t> level_begins(size_t points);
  /// The node above so many others, fan_out at most.
  static Node node_above(std::span<const Node> children);

  size_t size() const { return size_; }
  Vec3f position(uint32_t index) const {
    const Bucket& bucket = buckets_[index / bucket_size];
    const uint32_t lane = index % bucket_size;
    return {bucket.x[lane], bucket.y[lane], bucket.z[lane]};
  }
  /// Moves the point to infinity, where no search finds it.
  void remove(uint32_t index);
  bool removed(uint32_t index) const {
    return buckets_[index / bucket_size].x[index % bucket_size] == infinity;
  }

  /// Adds the points nearest to `query` that `filter` accepts; the caller starts and finishes.
  void nearest(const Vec3f& query, const Filter& filter, KdNeighbors<float>& neighbors) const;
  /// All points with distance_sq < radius_sq.
  void within(const Vec3f& query, float radius_sq, const Sink& sink) const;
  /// The buckets that may have points with distance_sq < radius_sq: all points that do are in them,
  /// bucket i holding the points from i · bucket_size on.
  void overlapping(const Vec3f& query, float radius_sq, const BucketSink& sink) const;
  /// Places of a bucket that hold no point are at infinity.
  const Bucket& bucket(uint32_t number) const { return buckets_[number]; }
  size_t bucket_count() const { return buckets_.size(); }
  std::span<const Bucket> buckets() const { return buckets_.all(); }
  /// Of all levels, the lowest first.
  std::span<const Node> nodes() const { return nodes_.all(); }
  /// All points in the closed box; distances are 0.
  void inside(const Vec3f& lower, const Vec3f& upper, const Sink& sink) const;

  /// Of memory of its own.
  size_t size_in_bytes() const { return buckets_.own_bytes() + nodes_.own_bytes(); }

 private:
  View view() const;
  void fill_nodes();

  KeptArray<Bucket> buckets_;
  KeptArray<Node> nodes_;            ///< all levels, level 0 first
  std::vector<size_t> level_begin_;  ///< and their end
  size_t size_ = 0;
};

}  // namespace kaustik
