#pragma once
#include <optional>

#include "kaustik/base/vec.h"

namespace kaustik {

/// CIE chromaticities (x, y) of a picture's red, green, blue and white.
struct Primaries {
  Vec2f red, green, blue, white;
};
/// Those of an Image.
Primaries rec709_primaries();

/// A linear change of colours.
struct ColourMatrix {
  Vec3d columns[3];
  Vec3f operator*(const Vec3f& c) const {
    return Vec3f(columns[0] * double(c.x) + columns[1] * double(c.y) + columns[2] * double(c.z));
  }
};

/// To linear Rec. 709 from the linear colours of `primaries`; their white becomes (1, 1, 1) by
/// Bradford's chromatic adaptation. None: they are Rec. 709, to a thousandth. Throws Error(input)
/// if they span no colours.
std::optional<ColourMatrix> rec709_from(const Primaries& primaries);

}  // namespace kaustik
