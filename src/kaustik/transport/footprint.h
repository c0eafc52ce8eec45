#pragma once
#include <algorithm>
#include <cmath>

#include "kaustik/material/bsdf.h"

namespace kaustik {

/// How wide the beam is that a path stands for; textures are filtered by it. Mirrors and glass
/// leave its spread as it is, whatever their curvature, so behind lenses textures are rather too
/// sharp than blurred.
struct Footprint {
  float width = 0;         ///< across the ray at the last vertex, m
  float spread = 0;        ///< growth of the width per metre
  float sharp_width = 0;   ///< the width without diffuse and glossy events, m …
  float sharp_spread = 0;  ///< … and its growth
  bool scattered = false;  ///< a diffuse or glossy event lies behind: normals are no longer
                           ///< filtered, since flat water would focus light elsewhere

  /// Of a beam that leaves the camera with this width and spread.
  static Footprint of_camera(float width, float spread) {
    Footprint footprint;
    footprint.width = footprint.sharp_width = width;
    footprint.spread = footprint.sharp_spread = spread;
    return footprint;
  }
  void travel(float distance) {
    width += spread * distance;
    sharp_width += sharp_spread * distance;
  }
  /// The path goes on by an event that was sampled with this density. Of a diffuse or glossy lobe
  /// the beam stands for a 64th: a cone whose solid angle is that of 1/64 of the chance.
  void scatter(Lobes event, float pdf_solid_angle) {
    if (event == Lobes::delta || !(pdf_solid_angle > 0)) return;
    constexpr float two_over_eight_sqrt_pi = 0.1410474f;
    const float cone = two_over_eight_sqrt_pi / std::sqrt(pdf_solid_angle);
    spread = std::max(spread, std::min(cone, 0.5f));
    scattered = true;
  }
};

}  // namespace kaustik
