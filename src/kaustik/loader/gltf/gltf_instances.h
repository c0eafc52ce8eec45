#pragma once
#include <map>
#include <memory>
#include <vector>

#include "kaustik/loader/gltf/gltf_meshes.h"

namespace kaustik::gltf {

/// Puts meshes where nodes have them. What would take much memory as copies becomes a shape group
/// and its instances.
class Instances {
 public:
  Instances(File& file, Accessors& accessors, Meshes& meshes, Deviations& deviations)
      : file_(file), accessors_(accessors), meshes_(meshes), deviations_(deviations) {}

  /// What nodes there are, which must outlive this; to be called first.
  void take_nodes(const std::vector<PlacedNode>& placed);

  /// The shapes of a node, in the world.
  Meshes::Shapes shapes_of(const PlacedNode& node, const Pose& pose);

  /// Multiplies the emission of all shapes that were made so far.
  void scale_emission(double factor);

 private:
  /// Of EXT_mesh_gpu_instancing: from an instance's space to the node's.
  std::vector<Transform> instance_transforms(const JsonValue& extension);
  std::shared_ptr<Object> group(size_t mesh, const JsonValue& at);
  bool is_worth_a_group(size_t mesh, const Meshes::Shapes& shapes) const;
  void add_placed(const std::shared_ptr<Object>& shape, const Transform& to_world,
                  Meshes::Shapes& result);

  File& file_;
  Accessors& accessors_;
  Meshes& meshes_;
  Deviations& deviations_;
  std::map<size_t, size_t> uses_;  ///< by mesh
  NodeWorlds worlds_;
  std::map<size_t, std::shared_ptr<Object>> groups_;
  std::vector<std::shared_ptr<Object>> emitters_;
};

}  // namespace kaustik::gltf
