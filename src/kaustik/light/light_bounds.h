#pragma once
#include "kaustik/base/vec.h"

namespace kaustik {

/// Bounds on where light goes, for choosing among many lights and for aiming.
struct LightBounds {
  Bounds3f position;    ///< empty for lights at infinity
  Vec3f axis{0, 0, 1};  ///< light leaves only within this angle of the axis
  float cos_angle = -1;
  bool infinite = false;
  /// Cosine of the cone of a surface's normals, about which light falls off by the cosine until it
  /// ends at `cos_angle`; equal to that where nothing is known to fall off.
  float cos_spread = -1;
};

}  // namespace kaustik
