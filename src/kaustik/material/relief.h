#pragma once
#include "kaustik/material/texture.h"

namespace kaustik {

/// A point of a surface whose normal is to be bent; vectors in the world.
struct ReliefPoint {
  TextureCoordinates texture;
  Vec3f normal;      ///< of the shading frame so far, unit
  Vec3f dpdu, dpdv;  ///< how the position changes with uv, m; zero where unknown
  const Transform* world_from_shape = nullptr;  ///< of instances; null: the identity
};

/// A relief that is too fine to be geometry: it only bends the normal.
class Relief {
 public:
  virtual ~Relief() = default;
  /// The bent normal, unit.
  virtual Vec3f normal(const ReliefPoint& at) const = 0;
};

}  // namespace kaustik
