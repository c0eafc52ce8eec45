#pragma once
#include <bit>
#include <cstdint>

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

/// log x of a finite, positive x that is not denormal, within 2e-7 (1 + |log x|): for random
/// depths, of which a path in a cloud draws many. log(1 + t) = t − t²/2 + t³ P(t) on [√½ − 1, √2 −
/// 1], with P fitted for the least largest error, which is 6.3e-8.
inline float approximate_log(float x) {
  constexpr auto least_bits = std::bit_cast<int32_t>(0.70710678f);
  const int32_t bits = std::bit_cast<int32_t>(x) - least_bits;
  const int32_t exponent = bits >> 23;
  const float t = std::bit_cast<float>((bits & 0x7fffff) + least_bits) - 1;
  const float p =
      0.33334691f +
      t * (-0.24980574f +
           t * (0.19910238f + t * (-0.17166907f + t * (0.16141176f + t * -0.10224201f))));
  return float(exponent) * 0.69314718f + (t + t * t * (t * p - 0.5f));
}

}  // namespace kaustik
