#include "kaustik/light/light_tree.h"

#include "kaustik/light/light_tree_build.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// A child that may light the point keeps at least this share of its parent's chance.
constexpr float minimum_share = 1.0f / 1024;

}  // namespace

LightTree::LightTree(std::vector<Item> items, size_t light_count) : paths_(light_count) {
  if (items.empty()) return;
  const LightTreeBuild build(std::move(items));
  const double scale = 1.0 / build.nodes().front().intensity;
  for (const LightTreeBuild::Node& from : build.nodes()) {
    Node node;
    node.emission = EmissionBall(from.position, from.emission, from.intensity * scale);
    node.leaf = from.light >= 0;
    node.child = node.leaf ? from.light : from.left;
    if (node.leaf) paths_[size_t(from.light)] = {from.turns, from.depth};
    nodes_.push_back(node);
  }
}

float LightTree::probability_of_left(const Node& node, const Vec3f& reference, const Vec3f& normal,
                                     bool informed) const {
  const Node& left = nodes_[size_t(node.child)];
  const Node& right = nodes_[size_t(node.child) + 1];
  float a = informed ? left.emission.irradiance(reference, normal) : 0.0f;
  float b = informed ? right.emission.irradiance(reference, normal) : 0.0f;
  if (a == 0 && b == 0) {
    // Not to be told apart, or neither can light the point, which the parent's looser bounds could
    // not tell.
    a = left.emission.intensity;
    b = right.emission.intensity;
  }
  if (a == 0) return 0;
  if (b == 0) return 1;
  return std::clamp(a / (a + b), minimum_share, 1.0f - minimum_share);
}

LightSelector::Choice LightTree::choose(const Vec3f& reference, const Vec3f& normal, float& u,
                                        int informed_depth) const {
  float probability = 1;
  const Node* node = &nodes_.front();
  for (int depth = 0; !node->leaf; ++depth) {
    const float left = probability_of_left(*node, reference, normal, depth < informed_depth);
    const bool go_right = !(u < left);
    const float share = go_right ? 1.0f - left : left;
    u = rescaled(u, go_right ? left : 0.0f, share);
    probability *= share;
    node = &nodes_[size_t(node->child) + go_right];
  }
  return {node->child, probability};
}

float LightTree::probability(const Vec3f& reference, const Vec3f& normal, int light,
                             int informed_depth) const {
  const Path& path = paths_[size_t(light)];
  if (path.depth < 0) return 0;
  float probability = 1;
  const Node* node = &nodes_.front();
  for (int i = 0; i < path.depth; ++i) {
    const float left = probability_of_left(*node, reference, normal, i < informed_depth);
    const bool go_right = (path.turns >> i) & 1;
    probability *= go_right ? 1.0f - left : left;
    node = &nodes_[size_t(node->child) + go_right];
  }
  return probability;
}

}  // namespace kaustik
