#include "kaustik/light/light_tree.h"

#include "kaustik/light/light_tree_build.h"

namespace kaustik {
namespace {

/// A light that may give anything is chosen at least this often, relative to the best one of its
/// node: there may be something in the way of that one …
constexpr float minimum_share_of_leaf = 1.0f / 32;
/// … which is less likely to hide it all if it is a group.
constexpr float minimum_share_of_best_group = 1.0f / 256;

/// The nodes of the binary tree that become children of one that is made of `from`: in its place
/// its two halves, then those of the largest of them, and so on.
std::vector<int> children_of(const LightTreeBuild& build, int from) {
  const auto& nodes = build.nodes();
  const auto lights = size_t(nodes[size_t(from)].lights);
  const size_t width = lights <= LightTree::most_lights ? lights : LightTree::most_children;
  std::vector<int> children{from};
  while (children.size() < width) {
    const auto largest = std::max_element(children.begin(), children.end(), [&](int a, int b) {
      return nodes[size_t(a)].lights < nodes[size_t(b)].lights;
    });
    const int left = nodes[size_t(*largest)].left;
    *largest = left;
    children.insert(largest + 1, left + 1);
  }
  return children;
}

}  // namespace

LightTree::LightTree(std::vector<Item> items, size_t light_count) : places_(light_count) {
  if (items.empty()) return;
  const LightTreeBuild build(std::move(items));
  intensity_ = build.nodes().front().intensity;
  nodes_.emplace_back();
  fill(build, 0, 0);
}

void LightTree::fill(const LightTreeBuild& build, size_t index, int from) {
  const std::vector<int> from_children = children_of(build, from);
  const auto first = uint32_t(children_.size());
  std::vector<EmissionBall> balls;
  bool groups = false;
  for (uint32_t place = 0; place < from_children.size(); ++place) {
    const LightTreeBuild::Node& child = build.nodes()[size_t(from_children[place])];
    balls.emplace_back(child.position, child.emission, child.intensity);
    if (child.light >= 0) {
      if (child.ball) balls.back() = *child.ball;
      children_.push_back(-1 - child.light);
      places_[size_t(child.light)] = {int32_t(index), place};
    } else {
      children_.push_back(int32_t(nodes_.size()));
      nodes_.emplace_back();
      nodes_.back().parent = int32_t(index);
      nodes_.back().place = place;
      groups = true;
    }
    balls.back().intensity =
        std::max(float(child.intensity / intensity_), std::numeric_limits<float>::min());
  }
  Node& node = nodes_[index];
  node.balls = balls_.add(balls);
  node.first_child = first;
  node.least = groups ? minimum_share_of_best_group : minimum_share_of_leaf;
  for (size_t place = 0; place < from_children.size(); ++place)
    if (const int32_t child = children_[first + place]; child >= 0)
      fill(build, size_t(child), from_children[place]);
}

void LightTree::weigh(const Node& node, const LightQuery& query, bool informed,
                      ChoiceWeights& weights) const {
  const uint32_t count = node.balls.count;
  if (informed) {
    balls_.irradiance(node.balls, query.reference, query.normal, weights.values());
    weights.raise(count, node.least);
    if (weights.sum() > 0) return;
  }
  // Not to be told apart, or none can light the point, which the parent's looser bounds could not
  // tell.
  weights.replace(count, balls_.intensities(node.balls));
}

LightSelector::Choice LightTree::choose(const LightQuery& query, const ChoiceWeights& root,
                                        float& u, int informed_depth) const {
  const Node* node = &nodes_.front();
  size_t place = root.choose(node->balls.count, u);
  float probability = root.probability(place);
  ChoiceWeights weights;
  for (int depth = 1; children_[node->first_child + place] >= 0; ++depth) {
    node = &nodes_[size_t(children_[node->first_child + place])];
    weigh(*node, query, depth < informed_depth, weights);
    place = weights.choose(node->balls.count, u);
    probability *= weights.probability(place);
  }
  return {-1 - children_[node->first_child + place], probability};
}

float LightTree::probability(const LightQuery& query, const ChoiceWeights& root, int light,
                             int informed_depth) const {
  const Place& at = places_[size_t(light)];
  if (at.node < 0) return 0;
  // The way up, to be gone down again: products by the order of choose().
  std::array<Place, whole_depth> way;
  size_t steps = 0;
  for (Place step = at; step.node >= 0;) {
    way[steps++] = step;
    const Node& node = nodes_[size_t(step.node)];
    step = {node.parent, node.place};
  }
  float probability = root.probability(way[steps - 1].child);
  ChoiceWeights weights;
  for (int depth = 1; depth < int(steps); ++depth) {
    const Place& step = way[steps - 1 - size_t(depth)];
    weigh(nodes_[size_t(step.node)], query, depth < informed_depth, weights);
    probability *= weights.probability(step.child);
  }
  return probability;
}

}  // namespace kaustik
