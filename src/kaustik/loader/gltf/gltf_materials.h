#pragma once
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "kaustik/loader/gltf/gltf_file.h"
#include "kaustik/loader/gltf/gltf_options.h"
#include "kaustik/loader/gltf/gltf_textures.h"

namespace kaustik::gltf {

/// What a shape gets by its material.
struct Surface {
  std::shared_ptr<Object> bsdf;
  std::shared_ptr<Object> interior;  ///< the medium of a body; null: none
  std::shared_ptr<Object> emitter;   ///< null: it does not shine
};

/// What matters to a material of the mesh that has it.
struct SurfaceUse {
  bool has_colors = false, has_opacities = false;  ///< of vertices
  bool is_closed = false;                          ///< asked where Materials::asks_if_closed()
  friend auto operator<=>(const SurfaceUse&, const SurfaceUse&) = default;
};

/// Makes bsdfs of a file's materials.
class Materials {
 public:
  Materials(File& file, const Options& options, Deviations& deviations);

  /// Of a material by its index; none: glTF's default, rough metal.
  const Surface& surface(std::optional<size_t> material, const SurfaceUse& use);
  /// Whether it depends on the mesh if the material is a pane or a body.
  bool asks_if_closed(std::optional<size_t> material) const;
  /// Whether something that was made shines with a strength of its own (beyond 1 cd/m²).
  bool has_bright_emission() const { return has_bright_emission_; }
  /// Which TEXCOORD_… its textures take; of several the base colour's.
  size_t uv_set(std::optional<size_t> material) const;

 private:
  Surface make(std::optional<size_t> index, const SurfaceUse& use);

  File& file_;
  const Options& options_;
  Deviations& deviations_;
  Textures textures_;
  bool has_bright_emission_ = false;
  JsonValue default_material_;
  std::map<std::pair<std::optional<size_t>, SurfaceUse>, Surface> known_;
};

}  // namespace kaustik::gltf
