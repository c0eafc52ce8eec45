#include "kaustik/irradiance/record_octree.h"

#include <utility>

namespace kaustik {
namespace {

constexpr int maximum_depth = 16;
constexpr size_t wanted_leaf_size = 16;
/// Splitting stops where it would copy records more than this many times.
constexpr float maximum_copies = 4;
constexpr float height_factor_front = 3;
constexpr float height_factor_behind = 10;

float distance_sq_to_box(const Vec3f& p, const Vec3f& lower, float size) {
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float outside = std::max({lower[axis] - p[axis], p[axis] - (lower[axis] + size), 0.0f});
    sum += sqr(outside);
  }
  return sum;
}

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
  explicit Builder(RecordOctree& tree) : tree_(tree), slack_(1e-5f * tree.size_) {}

  void build(uint32_t node, const Vec3f& lower, float size, int depth,
             const std::vector<uint32_t>& list) {
    for (const uint32_t record : list)
      tree_.nodes_[node].maximum_reach =
          std::max(tree_.nodes_[node].maximum_reach, tree_.records_[record].reach);
    if (list.size() > wanted_leaf_size && depth < maximum_depth) {
      std::vector<uint32_t> parts[8];
      const float half = 0.5f * size;
      size_t copies = 0;
      for (int child = 0; child < 8; ++child) {
        parts[child] = overlapping(list, lower + child_offset(child, half), half);
        copies += parts[child].size();
      }
      if (float(copies) <= maximum_copies * float(list.size())) {
        const auto first = uint32_t(tree_.nodes_.size());
        tree_.nodes_.resize(first + 8);
        tree_.nodes_[node].first = first;
        tree_.nodes_[node].inner = true;
        for (int child = 0; child < 8; ++child)
          build(first + uint32_t(child), lower + child_offset(child, half), half, depth + 1,
                parts[child]);
        return;
      }
    }
    make_leaf(tree_.nodes_[node], list);
  }

 private:
  std::vector<uint32_t> overlapping(const std::vector<uint32_t>& list, const Vec3f& lower,
                                    float size) const {
    std::vector<uint32_t> result;
    for (const uint32_t index : list) {
      const CacheRecord& record = tree_.records_[index];
      const float reach = record.reach * overlap + slack_;
      if (distance_sq_to_box(record.position, lower, size) <= reach * reach &&
          box_overlaps(record, lower, size))
        result.push_back(index);
    }
    return result;
  }

  bool box_overlaps(const CacheRecord& record, const Vec3f& lower, float size) const {
    const Vec3f half = half_extent(record) * overlap + Vec3f(slack_);
    const Vec3f low = lower - record.position, high = low + Vec3f(size);
    return low.x <= half.x && low.y <= half.y && low.z <= half.z && high.x >= -half.x &&
           high.y >= -half.y && high.z >= -half.z;
  }

  void make_leaf(Node& node, const std::vector<uint32_t>& list) {
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
        block.record[lane] = list[begin + lane];
      }
      tree_.blocks_.push_back(block);
    }
  }

  RecordOctree& tree_;
  float slack_;  ///< covers the rounding of a query's way to its leaf
};

RecordOctree::RecordOctree(std::vector<CacheRecord> records, float normal_tolerance)
    : records_(std::move(records)), inverse_normal_tolerance_sq_(1 / sqr(normal_tolerance)) {
  if (records_.empty()) return;
  Bounds3f bounds;
  std::vector<uint32_t> all;
  for (const CacheRecord& record : records_) {
    const Vec3f reach(record.reach * overlap);
    bounds.extendBy(record.position - reach);
    bounds.extendBy(record.position + reach);
    all.push_back(uint32_t(all.size()));
  }
  lower_ = bounds.min;
  size_ = max_abs(bounds.max - bounds.min) * 1.001f + 1e-6f * max_abs(bounds.max);
  cells_per_metre_ = float(1 << maximum_depth) / size_;
  nodes_.resize(1);
  Builder(*this).build(0, lower_, size_, 0, all);
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
  const Lanes error_sq = (dx * dx + dy * dy + dz * dz) * b.inverse_reach_sq + squeezed * squeezed +
                         factor_sq * height * height * b.inverse_minor_sq +
                         (1 - cosine) * inverse_normal_tolerance_sq_;
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

bool RecordOctree::serves(const Vec3f& position, const Vec3f& normal, float tolerance) const {
  const Node* leaf = leaf_at(position);
  if (!leaf) return false;
  for (uint32_t i = 0; i < leaf->blocks; ++i) {
    const Lanes error = error_sq(blocks_[leaf->first + i], {position, normal});
    const Lanes rest = tolerance * tolerance - error;
    if (rest[0] > 0 || rest[1] > 0 || rest[2] > 0 || rest[3] > 0) return true;
  }
  return false;
}

inline void RecordOctree::accumulate(const Block& block, const Point& at, Mean& mean) const {
  const Lanes weights = weight(error_sq(block, at), sqr(overlap));
  for (int lane = 0; lane < 4; ++lane)
    if (weights[lane] > 0) mean.add(records_[block.record[lane]], at, weights[lane]);
}

/// A record whose widened reach holds the point overlaps, unwidened, the ball of radius
/// (relax − 1) · overlap · reach about the point: it is listed in some leaf that meets this ball.
void RecordOctree::accumulate_relaxed(const Point& at, float relax, Mean& mean) const {
  struct Visit {
    uint32_t node;
    Vec3f lower;
    float size;
  };
  std::vector<Visit> open;
  std::vector<std::pair<uint32_t, float>> found;  // record and weight
  if (!nodes_.empty()) open.push_back({0, lower_, size_});
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const Node& node = nodes_[visit.node];
    const float radius = (relax - 1) * overlap * node.maximum_reach + 1e-5f * size_;
    if (!(distance_sq_to_box(at.position, visit.lower, visit.size) <= sqr(radius))) continue;
    const float half = 0.5f * visit.size;
    for (uint32_t child = 0; node.inner && child < 8; ++child)
      open.push_back({node.first + child, visit.lower + child_offset(int(child), half), half});
    for (uint32_t i = 0; i < node.blocks; ++i) {
      const Block& block = blocks_[node.first + i];
      const Lanes weights = weight(error_sq(block, at), sqr(overlap * relax));
      for (int lane = 0; lane < 4; ++lane)
        if (weights[lane] > 0) found.push_back({block.record[lane], weights[lane]});
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  for (const auto& [record, weight] : found) mean.add(records_[record], at, weight);
}

bool RecordOctree::interpolate(const Vec3f& position, const Vec3f& normal, float relax,
                               Spectrum& irradiance) const {
  const Point at{position, normal};
  Mean mean;
  if (relax > 1) {
    accumulate_relaxed(at, relax, mean);
  } else if (const Node* leaf = leaf_at(position)) {
    for (uint32_t i = 0; i < leaf->blocks; ++i) accumulate(blocks_[leaf->first + i], at, mean);
  }
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
