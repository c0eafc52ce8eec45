#pragma once
// Textures that lie by the place of a point in space: pbrt's mappings other than uv.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/scene/description.h"

namespace kaustik::pbrt {

enum class MappingKind : uint8_t { planar, spherical, cylindrical };
/// Nothing: "uv", or none at all.
std::optional<MappingKind> mapping_kind_named(std::string_view name);

struct SurfaceMapping {
  MappingKind kind = MappingKind::planar;
  Transform world_from_texture;
  /// Of planes: u and v are the products with these, and the deltas.
  Vec3d along_u = {1, 0, 0}, along_v = {0, 1, 0};
  double delta_u = 0, delta_v = 0;
  // For what is told.
  std::string name, object;  ///< "planar"; "texture 'wood'"
  Place place;
};

/// u and v of a point of the texture's space, as in pbrt-v4. The last one of a sphere and the first
/// one of a cylinder are angles, from 0 to 1.
std::array<double, 2> uv_at(const SurfaceMapping& mapping, const Vec3d& p);

/// Gives a mesh of buffers, which lies in the world by its to_world, the uv of a mapping: those at
/// its vertices. Where the angle begins anew vertices are doubled, and it goes on beyond 1. False:
/// it is no such mesh, or the texture's space has no volume.
bool lay_by(const SurfaceMapping& mapping, Object& shape);

/// All of a scene, by numbers; alike ones have the same.
class SurfaceMappings {
 public:
  static constexpr size_t by_uv = 0;  ///< the number of the surface's own coordinates

  size_t index_of(SurfaceMapping mapping);
  const SurfaceMapping& at(size_t index) const { return all_[index - 1]; }

 private:
  std::vector<SurfaceMapping> all_;
  std::map<std::vector<double>, size_t> known_;
};

/// What the textures of a surface lie by.
using MappingSet = std::set<size_t>;

}  // namespace kaustik::pbrt
