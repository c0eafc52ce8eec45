#include "kaustik/light/light_visibility.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kaustik/base/gap_split.h"

namespace kaustik {
namespace {

constexpr size_t largest_leaf = 32;
/// What the probes of a leaf find is mixed with as much as half a probe that finds a fifth of what
/// it expects, so that light through a gap which no probe met keeps a chance.
constexpr float prior_probes = 0.5f;
constexpr float prior_share = 0.2f;
/// A sample may find more than the estimate expects, by any factor at the edge of a lamp: beyond
/// this it says little of the region.
constexpr float largest_ratio = 4;

}  // namespace

struct LightVisibility::Learning {
  const std::vector<Probe>& probes;
  size_t lights;
  const std::vector<float>& expected;
  const std::vector<float>& found;
};

size_t LightVisibility::tree_of(const Vec3f& normal) {
  const Vec3f size(std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z));
  if (!(size.x + size.y + size.z > 0)) return tree_count - 1;
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  return size_t(2 * axis + (normal[axis] < 0));
}

LightVisibility::LightVisibility(const std::vector<Probe>& probes, size_t lights,
                                 const std::vector<float>& expected,
                                 const std::vector<float>& found) {
  std::array<std::vector<uint32_t>, tree_count> members;
  for (uint32_t i = 0; i < probes.size(); ++i) {
    members[tree_of(probes[i].normal)].push_back(i);
    members[tree_count - 1].push_back(i);
  }
  const Learning from{probes, lights, expected, found};
  for (size_t tree = 0; tree < tree_count; ++tree) {
    roots_[tree] = -1;
    if (members[tree].empty()) continue;
    roots_[tree] = int32_t(nodes_.size());
    nodes_.emplace_back();
    build(from, uint32_t(roots_[tree]), members[tree], 0, members[tree].size());
  }
}

/// Divides the probes across their widest side until few are left.
void LightVisibility::build(const Learning& from, uint32_t node, std::vector<uint32_t>& probes,
                            size_t begin, size_t end) {
  const auto at = [&](size_t i) { return probes.begin() + std::ptrdiff_t(i); };
  Bounds3f bounds;
  for (size_t i = begin; i < end; ++i) bounds.extendBy(from.probes[probes[i]].position);
  const Vec3f size = bounds.max - bounds.min;
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  const auto place = [&](uint32_t probe) { return from.probes[probe].position[axis]; };
  std::optional<float> split;
  if (end - begin > largest_leaf) {
    std::vector<float> places;
    for (size_t i = begin; i < end; ++i) places.push_back(place(probes[i]));
    // Paths from both ends must find the same region for points of a wall.
    split = split_in_gap(std::move(places), least_relative_gap * size[axis]);
  }
  if (!split) {
    add_leaf(from, nodes_[node], probes.data() + begin, probes.data() + end);
    return;
  }
  const auto second = std::stable_partition(at(begin), at(end),
                                            [&](uint32_t probe) { return place(probe) < *split; });
  const auto middle = size_t(second - probes.begin());
  const auto first = uint32_t(nodes_.size());
  nodes_.resize(first + 2);
  nodes_[node] = {*split, axis, first};
  build(from, first, probes, begin, middle);
  build(from, first + 1, probes, middle, end);
}

void LightVisibility::add_leaf(const Learning& from, Node& node, const uint32_t* begin,
                               const uint32_t* end) {
  // In order, so that sums have the same bits.
  std::vector<uint32_t> probes(begin, end);
  std::sort(probes.begin(), probes.end());
  node = {0, -1, uint32_t(shares_.size())};
  for (size_t light = 0; light < from.lights; ++light) {
    double expected = 0, found = 0;
    int asked = 0;
    for (const uint32_t probe : probes) {
      const size_t i = probe * from.lights + light;
      if (!(from.expected[i] > 0)) continue;
      expected += double(from.expected[i]);
      found += double(std::min(from.found[i], largest_ratio * from.expected[i]));
      ++asked;
    }
    const double prior = asked > 0 ? expected / asked * double(prior_probes) : 1.0;
    const double share = (found + double(prior_share) * prior) / (expected + prior);
    // Of what is there in a part of the region only, the chance that brings the least variance goes
    // by the root of the second moment, not by the mean: else there are bright dots where the edge
    // of a shadow falls into a region that is mostly dark.
    const float root = std::min(1.0f, float(std::sqrt(share)));
    shares_.push_back(found > 0 ? root : -root);
  }
}

const float* LightVisibility::shares(const Vec3f& reference, const Vec3f& normal) const {
  if (empty()) return nullptr;
  const int32_t root = roots_[tree_of(normal)];
  if (root < 0) return nullptr;
  const Node* node = &nodes_[size_t(root)];
  while (node->axis >= 0)
    node = &nodes_[node->first + (reference[node->axis] < node->split ? 0 : 1)];
  return &shares_[node->first];
}

}  // namespace kaustik
