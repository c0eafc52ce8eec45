#pragma once
// Meshes that joints and morph targets have moved, as they stand in the file.

#include <array>
#include <optional>
#include <vector>

#include "kaustik/loader/gltf/gltf_accessor.h"
#include "kaustik/loader/gltf/gltf_nodes.h"

namespace kaustik::gltf {

/// What moves the vertices of a mesh.
struct Deformation {
  /// Of morph targets; none: all are zero.
  std::vector<double> weights;
  /// Three rows of four for each joint, from the mesh's space to the world's; none: no skin.
  std::vector<std::array<float, 12>> joints;
  bool is_nothing() const { return weights.empty() && joints.empty(); }
};

/// Where nodes are, by their index; null: they are not in the scene.
using NodeWorlds = std::vector<const Transform*>;

/// Of a node that has a mesh, as the pose has it. Throws MissingData.
Deformation deformation_of(File& file, Accessors& accessors, const PlacedNode& node,
                           const JsonValue& mesh, const Pose& pose, const NodeWorlds& worlds);

/// The attribute POSITION or NORMAL of a primitive [count, 3] as it is moved: a new one, or
/// `values` if nothing moves it.
std::shared_ptr<const Array> deformed(File& file, Accessors& accessors, const JsonValue& primitive,
                                      const char* attribute, std::shared_ptr<const Array> values,
                                      const Deformation& deformation);

}  // namespace kaustik::gltf
