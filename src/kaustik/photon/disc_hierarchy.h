#pragma once
#include <array>
#include <vector>

#include "kaustik/base/vec.h"
#include "kaustik/geometry/ray.h"

namespace kaustik {

/// Discs that face whoever looks, in a hierarchy of boxes: all that a segment meets are found at
/// once, without steps along it. Immutable; searches are thread-safe.
class DiscHierarchy {
 public:
  struct Disc {
    Vec3f center;
    float radius;
  };
  DiscHierarchy() = default;
  /// What is near in the list should be near in space; see order_in_space().
  explicit DiscHierarchy(std::vector<Disc> discs);

  size_t size() const { return discs_.size(); }
  bool empty() const { return discs_.empty(); }
  float radius(size_t i) const { return discs_[i].radius; }
  const Vec3f& center(size_t i) const { return discs_[i].center; }

  /// visit(index, distance of the disc's foot on `ray`, squared distance of its centre from `ray`)
  /// of all whose foot lies within `length` (may be infinite) and whose radius reaches the ray.
  template <typename Visit>
  void visit_met(const Ray& ray, float length, const Visit& visit) const {
    if (discs_.empty()) return;
    const Vec3f& d = ray.direction;
    const Segment segment{ray.origin, {1 / d.x, 1 / d.y, 1 / d.z}, length};
    // A node's sibling waits while it is visited: one for each level at most.
    std::array<size_t, 64> waiting;
    size_t count = 0;
    waiting[count++] = 1;
    while (count > 0) {
      const size_t node = waiting[--count];
      if (boxes_[node].isEmpty() || !segment.meets(boxes_[node])) continue;
      if (node < first_leaf_) {
        waiting[count++] = 2 * node + 1;
        waiting[count++] = 2 * node;
        continue;
      }
      const size_t begin = (node - first_leaf_) * leaf_size;
      const size_t end = begin + leaf_size < discs_.size() ? begin + leaf_size : discs_.size();
      for (size_t i = begin; i < end; ++i) {
        const Vec3f to_center = discs_[i].center - ray.origin;
        const float along = dot(to_center, d);
        if (!(along > 0 && along < length)) continue;
        const float distance_sq = length_sq(to_center - d * along);
        if (distance_sq < sqr(discs_[i].radius)) visit(i, along, distance_sq);
      }
    }
  }

 private:
  /// A segment as box tests want it.
  struct Segment {
    Vec3f origin, inverse_direction;
    float length;
    bool meets(const Bounds3f& box) const;
  };

  static constexpr size_t leaf_size = 8;
  std::vector<Disc> discs_;
  /// A complete binary tree: the children of node i are 2i and 2i + 1, leaves begin at
  /// `first_leaf_`; node 0 is unused, boxes without discs are empty.
  std::vector<Bounds3f> boxes_;
  size_t first_leaf_ = 1;
};

/// Numbers of the points in an order in which neighbours in the list are neighbours in space.
std::vector<uint32_t> order_in_space(const std::vector<Vec3f>& points);

}  // namespace kaustik
