#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/light/emission_ball.h"
#include "kaustik/light/light.h"

namespace kaustik {

/// A binary tree over lights that have a place; a walk from the root chooses one, at every node the
/// child that may give more light to the reference point (Conty Estevez and Kulla, "Importance
/// Sampling of Many Lights with Adaptive Tree Splitting", PACMCGIT 2018; without splitting, so that
/// one light results).
class LightTree {
 public:
  struct Item {
    int light;  ///< index in the scene
    LightBounds bounds;
    double power;  ///< above 0
  };

  LightTree() = default;
  explicit LightTree(std::vector<Item> items, size_t light_count);

  bool empty() const { return nodes_.empty(); }
  static constexpr int whole_depth = 64;
  /// Not while empty. `u` is replaced by a fresh uniform number. Children of nodes at
  /// `informed_depth` and deeper are chosen by their intensity, whatever the point.
  LightSelector::Choice choose(const Vec3f& reference, const Vec3f& normal, float& u,
                               int informed_depth = whole_depth) const;
  /// Exactly what choose() reports; 0 for lights that are not in the tree.
  float probability(const Vec3f& reference, const Vec3f& normal, int light,
                    int informed_depth = whole_depth) const;

 private:
  /// The lights below a node.
  struct Node {
    EmissionBall emission;  ///< with a relative intensity
    bool leaf;
    int32_t child;  ///< the left child, the right one follows; of leaves the light
  };
  /// The way from the root to a light: bit i is set if it goes right at depth i.
  struct Path {
    uint64_t turns = 0;
    int depth = -1;  ///< −1: not in the tree
  };

  float probability_of_left(const Node& node, const Vec3f& reference, const Vec3f& normal,
                            bool informed) const;

  std::vector<Node> nodes_;
  std::vector<Path> paths_;  ///< per light of the scene
};

}  // namespace kaustik
