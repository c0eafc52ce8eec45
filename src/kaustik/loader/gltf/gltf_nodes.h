#pragma once
// The tree of nodes, and where it puts things in the world.

#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/loader/gltf/gltf_animation.h"

namespace kaustik::gltf {

/// A node of the scene that is shown.
struct PlacedNode {
  const JsonValue* node = nullptr;
  size_t index = 0;
  Transform to_world = {};
  bool is_there = true;  ///< false: it is squeezed to less than a plane
};

/// All nodes of the scene as the pose has them, parents before their children; what hides nodes is
/// minded. Throws Error(input) for nodes that are no tree.
std::vector<PlacedNode> placed_nodes(const File& file, const Pose& pose, Deviations& deviations);

}  // namespace kaustik::gltf
