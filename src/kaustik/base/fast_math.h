#pragma once
#include "kaustik/base/vec.h"

namespace kaustik {

/// The angle of (x, y) in (−π, π], within 3e-6: for texture coordinates on hot paths, where libm's
/// last bits cost more than the hit itself. Minimax polynomial for the arc tangent on [0, 1]
/// (Hastings 1955); zero for (0, 0).
inline float approximate_atan2(float y, float x) {
  const float ax = std::fabs(x), ay = std::fabs(y);
  const float large = std::max(ax, ay);
  if (large == 0) return 0;
  const float z = std::min(ax, ay) / large, s = z * z;
  float angle =
      z * (0.99997726f +
           s * (-0.33262347f +
                s * (0.19354346f + s * (-0.11643287f + s * (0.05265332f + s * -0.01172120f)))));
  if (ay > ax) angle = 0.5f * pi - angle;
  if (x < 0) angle = pi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace kaustik
