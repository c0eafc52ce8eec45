#pragma once
#include <map>
#include <memory>
#include <vector>

#include "kaustik/loader/gltf/gltf_accessor.h"
#include "kaustik/loader/gltf/gltf_deformation.h"
#include "kaustik/loader/gltf/gltf_materials.h"

namespace kaustik::gltf {

/// Makes shapes of a file's meshes: one for each primitive of triangles.
class Meshes {
 public:
  using Shapes = std::vector<std::shared_ptr<Object>>;

  Meshes(File& file, Accessors& accessors, Materials& materials, const Options& options,
         Deviations& deviations);

  /// In the mesh's own space. They are made once.
  const Shapes& shapes(size_t mesh, const JsonValue& at);
  /// Moved by joints or morph targets.
  Shapes deformed_shapes(size_t mesh, const Deformation& deformation, const JsonValue& at);

 private:
  /// Of one primitive.
  struct Part {
    const JsonValue& primitive;
    const JsonValue& attributes;
    std::string name;  ///< of the mesh, for messages
    std::optional<size_t> material;
    Place place;
  };

  Shapes make(size_t mesh, const Deformation& deformation, const JsonValue& at);
  std::shared_ptr<Object> shape_of(const Part& part, const Deformation& deformation);
  std::shared_ptr<Object> stand_in(const Part& part, const std::string& why);
  std::optional<size_t> material_of(const JsonValue& primitive) const;
  std::shared_ptr<const Array> faces_of(const Part& part, size_t vertices);
  /// An attribute of so many vertices, as floats; null: there is none.
  std::shared_ptr<const Array> attribute(const Part& part, const std::string& name, size_t vertices,
                                         size_t least, size_t most);
  void give_uvs(const Part& part, size_t vertices, Object& shape);
  void give_colors(const Part& part, size_t vertices, Object& shape, SurfaceUse& use);
  void give_surface(const Part& part, const SurfaceUse& use, Object& shape);
  bool needs_opacity(const Part& part) const;

  File& file_;
  Accessors& accessors_;
  Materials& materials_;
  Deviations& deviations_;
  std::optional<size_t> variant_;
  std::map<size_t, Shapes> known_;
};

}  // namespace kaustik::gltf
