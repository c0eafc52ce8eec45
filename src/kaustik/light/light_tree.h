#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "kaustik/light/choice_weights.h"
#include "kaustik/light/emission_ball.h"
#include "kaustik/light/light.h"

namespace kaustik {

class LightTreeBuild;

/// A tree over lights that have a place; a walk from the root chooses one, at every node the child
/// that may give more light to the reference point (Conty Estevez and Kulla, "Importance Sampling
/// of Many Lights with Adaptive Tree Splitting", PACMCGIT 2018; without splitting, so that one
/// light results). A node has up to 16 children, or up to 48 lights alone, which are weighed
/// together: few lights are all compared with one another, and of many only bounds that tell them
/// apart are looked at.
class LightTree {
 public:
  struct Item {
    int light;  ///< index in the scene
    LightBounds bounds;
    double power;  ///< above 0
    /// Tells better than the bounds what the light gives; null: they tell as much.
    const EmissionBall* ball = nullptr;
  };
  static constexpr size_t most_children = 16, most_lights = 48;
  static_assert(std::max(most_children, most_lights) <= ChoiceWeights::most);
  static constexpr int whole_depth = 64;

  LightTree() = default;
  /// `light_count`: of the scene.
  LightTree(std::vector<Item> items, size_t light_count);

  bool empty() const { return nodes_.empty(); }
  /// What the root's children may give, for several choices at one point. Not while empty. Children
  /// of nodes at `informed_depth` and deeper are chosen by their intensity, whatever the point.
  void weigh(const LightQuery& query, ChoiceWeights& root, int informed_depth = whole_depth) const {
    weigh(nodes_.front(), query, informed_depth > 0, root);
  }
  /// Upper estimate of the irradiance, W/m², sum of the lanes; by weigh().
  double expected_irradiance(const ChoiceWeights& root) const { return root.sum() * intensity_; }
  /// `u` is replaced by a fresh uniform number.
  LightSelector::Choice choose(const LightQuery& query, const ChoiceWeights& root, float& u,
                               int informed_depth = whole_depth) const;
  /// Exactly what choose() reports; 0 for lights that are not in the tree.
  float probability(const LightQuery& query, const ChoiceWeights& root, int light,
                    int informed_depth = whole_depth) const;

 private:
  struct Node {
    EmissionBalls::Block balls;  ///< of the children, with relative intensities
    uint32_t first_child;        ///< in children_
    int32_t parent = -1;
    uint32_t place = 0;  ///< among the parent's children
    float least;         ///< see ChoiceWeights::raise()
  };
  /// Where a light is; node −1: nowhere.
  struct Place {
    int32_t node = -1;
    uint32_t child = 0;
  };

  /// Makes node `index` of a node of the binary tree, and those below it.
  void fill(const LightTreeBuild& build, size_t index, int from);
  void weigh(const Node& node, const LightQuery& query, bool informed,
             ChoiceWeights& weights) const;

  std::vector<Node> nodes_;        ///< the root first
  std::vector<int32_t> children_;  ///< a node, or −1 − a light
  EmissionBalls balls_;
  std::vector<Place> places_;  ///< per light of the scene
  double intensity_ = 0;       ///< the unit of relative intensities, W/sr
};

}  // namespace kaustik
