#include "kaustik/image/photometry.h"

#include <cmath>

namespace kaustik {

// Rec. 709 primaries with white D65 (x = 0.3127, y = 0.3290), and the inverse matrix.
Vec3f xyz_from_rgb(const Vec3f& c) {
  return {0.4123908f * c.x + 0.3575843f * c.y + 0.1804808f * c.z, photopic(c),
          0.0193308f * c.x + 0.1191948f * c.y + 0.9505322f * c.z};
}

Vec3f rgb_from_xyz(const Vec3f& c) {
  return {3.2409699f * c.x - 1.5373832f * c.y - 0.4986108f * c.z,
          -0.9692436f * c.x + 1.8759675f * c.y + 0.0415551f * c.z,
          0.0556301f * c.x - 0.2039770f * c.y + 1.0569715f * c.z};
}

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
