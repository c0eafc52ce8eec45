#pragma once
#include "kaustik/light/emission_cone.h"
#include "kaustik/light/light_tree.h"

namespace kaustik {

/// Builds the nodes of a LightTree, one light per leaf, splitting by the surface area orientation
/// heuristic (Conty Estevez and Kulla 2018, eq. 2).
class LightTreeBuild {
 public:
  struct Node {
    Bounds3f position;
    EmissionCone emission;
    double intensity = 0;
    int light = -1;  ///< of leaves
    int left = -1;   ///< of inner nodes; the right child follows
    uint64_t turns = 0;
    int depth = 0;
  };
  /// At least one item.
  explicit LightTreeBuild(std::vector<LightTree::Item> items);
  /// The root first.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void fill(size_t index, size_t begin, size_t end);
  size_t split(size_t begin, size_t end, int depth);

  std::vector<Node> leaves_;
  std::vector<Node> nodes_;
};

}  // namespace kaustik
