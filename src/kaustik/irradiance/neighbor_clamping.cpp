#include "kaustik/irradiance/neighbor_clamping.h"

namespace kaustik {
namespace {

constexpr uint32_t leaf_size = 8;

float distance_to_box(const Vec3f& p, const Bounds3f& box) {
  Vec3f outside;
  for (int axis = 0; axis < 3; ++axis)
    outside[axis] = std::max({box.min[axis] - p[axis], p[axis] - box.max[axis], 0.0f});
  return length(outside);
}

}  // namespace

NeighborClamping::NeighborClamping(std::vector<Site> sites) : sites_(std::move(sites)) {
  if (!sites_.empty()) build(0, uint32_t(sites_.size()));
}

void NeighborClamping::build(uint32_t begin, uint32_t end) {
  const size_t number = nodes_.size();
  Node node;
  for (uint32_t i = begin; i < end; ++i) {
    node.bounds.extendBy(sites_[i].position);
    node.least = std::min(node.least, sites_[i].distance);
  }
  node.begin = begin;
  node.end = end;
  nodes_.push_back(node);
  if (end - begin <= leaf_size) return;
  const auto axis = int(node.bounds.majorAxis());
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(
      sites_.begin() + begin, sites_.begin() + middle, sites_.begin() + end,
      [axis](const Site& a, const Site& b) { return a.position[axis] < b.position[axis]; });
  build(begin, middle);
  nodes_[number].second = uint32_t(nodes_.size());
  build(middle, end);
}

float NeighborClamping::clamped(const Vec3f& position, const Vec3f& normal, float distance) const {
  uint32_t open[64];  // halving 2³² sites takes no more
  int count = 0;
  if (!nodes_.empty()) open[count++] = 0;
  while (count > 0) {
    const uint32_t number = open[--count];
    const Node& node = nodes_[number];
    if (!(node.least + distance_to_box(position, node.bounds) < distance)) continue;
    if (node.second > 0) {
      open[count++] = node.second;
      open[count++] = number + 1;
      continue;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      const Site& site = sites_[i];
      if (dot(normal, site.normal) >= 0)
        distance = std::min(distance, site.distance + length(position - site.position));
    }
  }
  return distance;
}

}  // namespace kaustik
