#include "kaustik/base/srgb.h"

#include <cmath>

namespace kaustik {

float srgb_from_linear(float linear) {
  const float x = std::fabs(linear);
  const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return std::copysign(encoded, linear);
}

float linear_from_srgb(float encoded) {
  const float x = std::fabs(encoded);
  const float linear = x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
  return std::copysign(linear, encoded);
}

}  // namespace kaustik
