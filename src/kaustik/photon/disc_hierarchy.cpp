#include "kaustik/photon/disc_hierarchy.h"

#include <bit>
#include <numeric>

#include "kaustik/photon/kd_tree/kd_tree.h"

namespace kaustik {

bool DiscHierarchy::Segment::meets(const Bounds3f& box) const {
  float near = 0, far = length;
  for (int axis = 0; axis < 3; ++axis) {
    const float a = (box.min[axis] - origin[axis]) * inverse_direction[axis];
    const float b = (box.max[axis] - origin[axis]) * inverse_direction[axis];
    // 0 · ∞ on the border of a slab along the ray is not a number: the comparisons leave it out.
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

DiscHierarchy::DiscHierarchy(std::vector<Disc> discs) : discs_(std::move(discs)) {
  if (discs_.empty()) return;
  const size_t leaves = (discs_.size() + leaf_size - 1) / leaf_size;
  first_leaf_ = std::bit_ceil(leaves);
  boxes_.assign(2 * first_leaf_, Bounds3f());
  for (size_t i = 0; i < discs_.size(); ++i) {
    const Vec3f reach(discs_[i].radius);
    boxes_[first_leaf_ + i / leaf_size].extendBy(discs_[i].center - reach);
    boxes_[first_leaf_ + i / leaf_size].extendBy(discs_[i].center + reach);
  }
  for (size_t node = first_leaf_ - 1; node > 0; --node)
    for (const size_t child : {2 * node, 2 * node + 1})
      if (!boxes_[child].isEmpty()) boxes_[node].extendBy(boxes_[child]);
}

std::vector<uint32_t> order_in_space(const std::vector<Vec3f>& points) {
  std::vector<uint32_t> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  KdTree<3, Vec3f, uint32_t> tree;
  tree.assign(points, std::move(numbers));
  std::vector<uint32_t> order(points.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = tree.data(uint32_t(i));
  return order;
}

}  // namespace kaustik
