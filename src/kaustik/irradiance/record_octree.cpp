#include "kaustik/irradiance/record_octree.h"

#include <bit>
#include <span>
#include <utility>

namespace kaustik {
namespace {

constexpr int maximum_depth = 16;
constexpr size_t wanted_leaf_size = 16;
/// Splitting stops where it would copy records more than this many times.
constexpr float maximum_copies = 4;
constexpr float height_factor_front = 3;
constexpr float height_factor_behind = 10;

/// Half the size of the box around the ellipsoid d²/reach² + (d·squeeze)² ≤ 1.
Vec3f half_extent(const CacheRecord& record) {
  const float ratio = record.inverse_reach_sq() / record.inverse_minor_sq();
  Vec3f half;
  for (int axis = 0; axis < 3; ++axis)
    half[axis] = record.reach * safe_sqrt(1 - sqr(record.reach * record.squeeze[axis]) * ratio);
  return half;
}

Vec3f child_offset(int child, float size) {
  return Vec3f(float(child & 1), float((child >> 1) & 1), float((child >> 2) & 1)) * size;
}

}  // namespace

/// Splits cells until few records are left in each.
class RecordOctree::Builder {
 public:
  explicit Builder(RecordOctree& tree) : tree_(tree) {
    const float slack = 1e-5f * tree.size_;  // covers the rounding of a query's way to its leaf
    regions_.reserve(tree.records_.size());
    for (const CacheRecord& record : tree.records_) {
      regions_.push_back({record.position, sqr(record.reach * overlap + slack),
                          half_extent(record) * overlap + Vec3f(slack)});
      lists_.push_back(uint32_t(lists_.size()));
    }
  }

  void build() { build(0, tree_.lower_, tree_.size_, 0, 0); }

 private:
  /// Where a record takes part: in a ball and in a box.
  struct Region {
    Vec3f center;
    float radius_sq;
    Vec3f half_extent;
  };

  /// The node's records are those of lists_ from `begin` on, and left there.
  void build(uint32_t number, const Vec3f& lower, float size, int depth, size_t begin) {
    const size_t end = lists_.size(), count = end - begin;
    const float half = 0.5f * size;
    if (count <= wanted_leaf_size || depth >= maximum_depth || !split(lower, half, begin)) {
      make_leaf(tree_.nodes_[number], {lists_.data() + begin, count});
      return;
    }
    const auto first = uint32_t(tree_.nodes_.size());
    tree_.nodes_.resize(first + 8);
    tree_.nodes_[number].first = first;
    tree_.nodes_[number].inner = true;
    const size_t first_mask = masks_.size() - count;
    for (uint32_t child = 0; child < 8; ++child) {
      for (size_t i = 0; i < count; ++i)
        if ((masks_[first_mask + i] >> child) & 1) lists_.push_back(lists_[begin + i]);
      build(first + child, lower + child_offset(int(child), half), half, depth + 1, end);
      lists_.resize(end);
    }
    masks_.resize(first_mask);
  }

  /// Puts onto masks_ which children each of the node's records reaches; false, and nothing is put
  /// there, if splitting would copy too many.
  bool split(const Vec3f& lower, float half, size_t begin) {
    const size_t first_mask = masks_.size();
    size_t copies = 0;
    for (size_t i = begin; i < lists_.size(); ++i) {
      masks_.push_back(children_reached(regions_[lists_[i]], lower, half));
      copies += size_t(std::popcount(masks_.back()));
    }
    if (float(copies) <= maximum_copies * float(lists_.size() - begin)) return true;
    masks_.resize(first_mask);
    return false;
  }

  /// One bit per child, of edge `half`.
  static uint8_t children_reached(const Region& region, const Vec3f& lower, float half) {
    float outside_sq[3][2];  // of the ball's centre, by axis and side
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        const float low = lower[axis] + float(side) * half - region.center[axis];
        const float outside = std::max({low, -(low + half), 0.0f});
        outside_sq[axis][side] = outside <= region.half_extent[axis] ? sqr(outside) : infinity;
      }
    unsigned mask = 0;
    for (unsigned child = 0; child < 8; ++child) {
      const float distance_sq =
          outside_sq[0][child & 1] + outside_sq[1][(child >> 1) & 1] + outside_sq[2][child >> 2];
      if (distance_sq <= region.radius_sq) mask |= 1u << child;
    }
    return uint8_t(mask);
  }

  void make_leaf(Node& node, std::span<const uint32_t> list) {
    node.first = uint32_t(tree_.blocks_.size());
    node.blocks = uint32_t((list.size() + 3) / 4);
    for (size_t begin = 0; begin < list.size(); begin += 4) {
      Block block{};
      for (size_t lane = 0; lane < 4 && begin + lane < list.size(); ++lane) {
        const CacheRecord& record = tree_.records_[list[begin + lane]];
        for (int axis = 0; axis < 3; ++axis) {
          block.position[axis][lane] = record.position[axis];
          block.normal[axis][lane] = record.normal[axis];
          block.squeeze[axis][lane] = record.squeeze[axis];
        }
        block.inverse_reach_sq[lane] = record.inverse_reach_sq();
        block.inverse_minor_sq[lane] = record.inverse_minor_sq();
        block.turning[lane] = record.turning;
        block.half_pixel_sq[lane] = sqr(0.5f * record.pixel_width);
        block.record[lane] = list[begin + lane];
      }
      tree_.blocks_.push_back(block);
    }
  }

  RecordOctree& tree_;
  std::vector<Region> regions_;
  std::vector<uint32_t> lists_;  ///< a stack: the records of the node and of those above it
  std::vector<uint8_t> masks_;   ///< a stack, of the nodes above
};

RecordOctree::RecordOctree(std::vector<CacheRecord> records, float normal_tolerance)
    : records_(std::move(records)), inverse_normal_tolerance_sq_(1 / sqr(normal_tolerance)) {
  if (records_.empty()) return;
  Bounds3f bounds;
  for (const CacheRecord& record : records_) {
    const Vec3f reach(record.reach * overlap);
    bounds.extendBy(record.position - reach);
    bounds.extendBy(record.position + reach);
  }
  lower_ = bounds.min;
  size_ = max_abs(bounds.max - bounds.min) * 1.001f + 1e-6f * max_abs(bounds.max);
  cells_per_metre_ = float(1 << maximum_depth) / size_;
  nodes_.resize(1);
  Builder(*this).build();
}

inline RecordOctree::Lanes RecordOctree::error_sq(const Block& b, const Point& at) const {
  const Vec3f& n = at.normal;
  const Lanes dx = at.position.x - b.position[0];
  const Lanes dy = at.position.y - b.position[1];
  const Lanes dz = at.position.z - b.position[2];
  const Lanes cosine = n.x * b.normal[0] + n.y * b.normal[1] + n.z * b.normal[2];
  const Lanes height =
      0.5f * (dx * (n.x + b.normal[0]) + dy * (n.y + b.normal[1]) + dz * (n.z + b.normal[2]));
  const Lanes front = Lanes{} + sqr(height_factor_front);
  const Lanes behind = Lanes{} + sqr(height_factor_behind);
  const Lanes factor_sq = height < 0 ? behind : front;
  const Lanes squeezed = dx * b.squeeze[0] + dy * b.squeeze[1] + dz * b.squeeze[2];
  const Lanes one = Lanes{} + 1;
  const Lanes narrower_sq = b.half_pixel_sq * at.inverse_pixel_sq;
  const Lanes error_sq = ((dx * dx + dy * dy + dz * dz) * b.inverse_reach_sq + squeezed * squeezed +
                          factor_sq * height * height * b.inverse_minor_sq) *
                             (narrower_sq > one ? narrower_sq : one) +
                         (1 - cosine) * b.turning * inverse_normal_tolerance_sq_;
  const Lanes never = Lanes{} + infinity;
  return cosine > 0 ? error_sq : never;
}

/// 0 beyond the limit.
inline RecordOctree::Lanes RecordOctree::weight(Lanes error_sq, float limit_sq) {
  const Lanes rest = 1 - error_sq * (1 / limit_sq);
  return rest > 0 ? rest * rest : Lanes{};
}

inline const RecordOctree::Node* RecordOctree::leaf_at(const Vec3f& position) const {
  const Vec3f p = position - lower_;
  const bool inside = p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size_ && p.y < size_ && p.z < size_;
  if (!inside) return nullptr;
  const auto x = uint32_t(p.x * cells_per_metre_);
  const auto y = uint32_t(p.y * cells_per_metre_);
  const auto z = uint32_t(p.z * cells_per_metre_);
  const Node* node = nodes_.data();
  for (int level = maximum_depth - 1; node->inner; --level) {
    const uint32_t child =
        ((x >> level) & 1) | (((y >> level) & 1) << 1) | (((z >> level) & 1) << 2);
    node = &nodes_[node->first + child];
  }
  return node;
}

bool RecordOctree::serves(const Vec3f& position, const Vec3f& normal, float tolerance,
                          float pixel_width) const {
  const Node* leaf = leaf_at(position);
  if (!leaf) return false;
  const Point at(position, normal, pixel_width);
  for (uint32_t i = 0; i < leaf->blocks; ++i) {
    const Lanes error = error_sq(blocks_[leaf->first + i], at);
    const Lanes rest = tolerance * tolerance - error;
    if (rest[0] > 0 || rest[1] > 0 || rest[2] > 0 || rest[3] > 0) return true;
  }
  return false;
}

inline void RecordOctree::accumulate(const Node& leaf, const Point& at, float relax,
                                     Mean& mean) const {
  for (uint32_t i = 0; i < leaf.blocks; ++i) {
    const Block& block = blocks_[leaf.first + i];
    const Lanes weights = weight(error_sq(block, at), sqr(overlap * relax));
    for (int lane = 0; lane < 4; ++lane)
      if (weights[lane] > 0) mean.add(records_[block.record[lane]], at, weights[lane]);
  }
}

bool RecordOctree::interpolate(const Vec3f& position, const Vec3f& normal, float relax,
                               Spectrum& irradiance, float pixel_width) const {
  const Point at(position, normal, pixel_width);
  Mean mean;
  if (const Node* leaf = leaf_at(position)) accumulate(*leaf, at, relax, mean);
  if (!(mean.weight > 0)) return false;
  const Spectrum::Register lanes = (mean.weighted / mean.weight).lanes();
  irradiance = Spectrum(lanes > 0 ? lanes : Spectrum::Register{});
  return true;
}

size_t RecordOctree::size_in_bytes() const {
  return records_.capacity() * sizeof(CacheRecord) + nodes_.capacity() * sizeof(Node) +
         blocks_.capacity() * sizeof(Block);
}

}  // namespace kaustik
