#pragma once
#include "kaustik/light/emission_cone.h"
#include "kaustik/light/light_tree.h"

namespace kaustik {

/// A binary tree over lights, one per leaf, split by the surface area orientation heuristic (Conty
/// Estevez and Kulla 2018, eq. 2): what a LightTree makes its wider nodes of.
class LightTreeBuild {
 public:
  struct Node {
    Bounds3f position;
    EmissionCone emission;
    double intensity = 0;
    int light = -1;                      ///< of leaves
    const EmissionBall* ball = nullptr;  ///< of leaves; may be null
    int left = -1;                       ///< of inner nodes; the right child follows
    int lights = 1;                      ///< below it
    int depth = 0;
  };
  /// At least one item.
  explicit LightTreeBuild(std::vector<LightTree::Item> items);
  /// The root first; at most 64 deep.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void fill(size_t index, size_t begin, size_t end);
  size_t split(size_t begin, size_t end, int depth);

  std::vector<Node> leaves_;
  std::vector<Node> nodes_;
};

}  // namespace kaustik
