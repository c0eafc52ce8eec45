#include "kaustik/image/photometry.h"

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

}  // namespace kaustik
