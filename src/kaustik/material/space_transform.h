#pragma once
#include "kaustik/material/texture.h"

namespace kaustik {

/// Takes positions to the space of a texture that fills space, by its parameter `to_world`.
class SpaceTransform {
 public:
  explicit SpaceTransform(const Transform& to_world)
      : world_from_texture_(to_world),
        texture_from_world_(to_world.inverse()),
        scale_(float(1 / std::cbrt(std::fabs(to_world.determinant3())))) {}

  /// Far from the origin floats have lost all detail anyway; the bound keeps squares finite.
  Vec3f point(const TextureCoordinates& at) const {
    static constexpr float farthest = 1e9f;
    const Vec3f p = texture_from_world_.point(at.position);
    // In this order what is no number becomes one.
    const auto within = [](float x) { return std::min(std::max(-farthest, x), farthest); };
    return {within(p.x), within(p.y), within(p.z)};
  }
  Vec3f normal(const TextureCoordinates& at) const {
    return normalize(texture_from_world_.normal(at.normal));
  }
  float width(const TextureCoordinates& at) const { return scale_ * at.width; }
  /// Of a gradient by the texture's coordinates, to one by the original position.
  Vec3f gradient(const Vec3f& g) const { return world_from_texture_.normal(g); }

 private:
  Transform world_from_texture_, texture_from_world_;
  float scale_;
};

/// The row of that parameter.
inline Parameter texture_to_world_parameter() {
  return transform_parameter("to_world",
                             "Places the texture in the world, or in the group's space within a "
                             "shape group. Its unit is the metre.");
}

}  // namespace kaustik
