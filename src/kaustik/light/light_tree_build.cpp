#include "kaustik/light/light_tree_build.h"

#include <array>

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

constexpr int bin_count = 12;
/// Deeper than this nodes are halved by count, so that no way to one of 2³¹ lights is longer than
/// LightTree::whole_depth.
constexpr int maximum_heuristic_depth = 32;

/// Some lights together.
struct Group {
  Bounds3f position;
  EmissionCone emission;
  double intensity = 0;
  int count = 0;

  void add(const Bounds3f& bounds, const EmissionCone& cone, double added_intensity, int added) {
    position.extendBy(bounds);
    emission = count == 0 ? cone : united(emission, cone);
    intensity += added_intensity;
    count += added;
  }
  void add(const LightTreeBuild::Node& n) { add(n.position, n.emission, n.intensity, n.lights); }
  void add(const Group& g) {
    if (g.count > 0) add(g.position, g.emission, g.intensity, g.count);
  }
  double cost() const {
    if (count == 0) return 0;
    // Lamps in a row have boxes without an area: the diagonal still tells near from far.
    const double size = surface_area(position) + length_sq(position.max - position.min);
    return intensity * size * orientation_measure(emission);
  }
};

using Bins = std::array<Group, bin_count>;

/// The cheapest border between bins as (cost, number of bins on its left); infinite if none.
std::pair<double, int> cheapest_border(const Bins& bins) {
  std::array<double, bin_count> right_cost{};
  Group right;
  for (int i = bin_count - 1; i > 0; --i) {
    right.add(bins[size_t(i)]);
    right_cost[size_t(i)] = right.count > 0 ? right.cost() : -1;
  }
  std::pair<double, int> best{std::numeric_limits<double>::infinity(), 0};
  Group left;
  for (int i = 1; i < bin_count; ++i) {
    left.add(bins[size_t(i) - 1]);
    if (left.count == 0 || right_cost[size_t(i)] < 0) continue;
    best = std::min(best, {left.cost() + right_cost[size_t(i)], i});
  }
  return best;
}

}  // namespace

LightTreeBuild::LightTreeBuild(std::vector<LightTree::Item> items) {
  for (const LightTree::Item& item : items) {
    Node leaf;
    leaf.position = item.bounds.position;
    leaf.emission = emission_cone(item.bounds);
    leaf.intensity =
        item.ball ? double(item.ball->intensity) : item.power / orientation_measure(leaf.emission);
    leaf.light = item.light;
    leaf.ball = item.ball;
    leaves_.push_back(leaf);
  }
  nodes_.reserve(2 * leaves_.size());
  nodes_.emplace_back();
  fill(0, 0, leaves_.size());
}

void LightTreeBuild::fill(size_t index, size_t begin, size_t end) {
  const int depth = nodes_[index].depth;
  if (end - begin == 1) {
    nodes_[index] = leaves_[begin];
    nodes_[index].depth = depth;
    return;
  }
  const size_t middle = split(begin, end, depth);
  const size_t left = nodes_.size();
  nodes_.resize(left + 2);
  nodes_[left].depth = nodes_[left + 1].depth = depth + 1;
  fill(left, begin, middle);
  fill(left + 1, middle, end);
  Group both;
  both.add(nodes_[left]);
  both.add(nodes_[left + 1]);
  Node& node = nodes_[index];
  node.position = both.position;
  node.emission = both.emission;
  node.intensity = both.intensity;
  node.left = int(left);
  node.lights = both.count;
}

size_t LightTreeBuild::split(size_t begin, size_t end, int depth) {
  const auto first = leaves_.begin() + std::ptrdiff_t(begin);
  const auto last = leaves_.begin() + std::ptrdiff_t(end);
  Bounds3f centers;
  for (auto leaf = first; leaf != last; ++leaf) centers.extendBy(center(leaf->position));
  const Vec3f size = centers.max - centers.min;
  const auto bin_of = [&](const Node& leaf, int axis) {
    const float x = (center(leaf.position)[axis] - centers.min[axis]) / size[axis];
    return to_integer(x * float(bin_count), 0, bin_count - 1);
  };

  double best_cost = std::numeric_limits<double>::infinity();
  int best_axis = 0, best_border = 0;
  for (int axis = 0; axis < 3 && depth < maximum_heuristic_depth; ++axis) {
    if (!(size[axis] > 0)) continue;
    Bins bins;
    for (auto leaf = first; leaf != last; ++leaf) bins[size_t(bin_of(*leaf, axis))].add(*leaf);
    auto [cost, border] = cheapest_border(bins);
    cost *= max_abs(size) / size[axis];  // the paper's k_r against thin slices
    if (cost < best_cost) {
      best_cost = cost;
      best_axis = axis;
      best_border = border;
    }
  }
  if (best_border == 0) return begin + (end - begin) / 2;
  const auto middle = std::stable_partition(
      first, last, [&](const Node& leaf) { return bin_of(leaf, best_axis) < best_border; });
  return size_t(middle - leaves_.begin());
}

}  // namespace kaustik
