// The matrices of SMPTE RP 177-1993; the adaptation is that of Lam (1985), as in Lindbloom,
// "Chromatic Adaptation".

#include "kaustik/image/primaries.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

Vec3d times(const ColourMatrix& m, const Vec3d& v) {
  return m.columns[0] * v.x + m.columns[1] * v.y + m.columns[2] * v.z;
}
ColourMatrix times(const ColourMatrix& a, const ColourMatrix& b) {
  return {{times(a, b.columns[0]), times(a, b.columns[1]), times(a, b.columns[2])}};
}
ColourMatrix scaled(const ColourMatrix& m, const Vec3d& by) {
  return {{m.columns[0] * by.x, m.columns[1] * by.y, m.columns[2] * by.z}};
}

ColourMatrix inverse(const ColourMatrix& m) {
  const Vec3d &a = m.columns[0], &b = m.columns[1], &c = m.columns[2];
  const double volume = a.dot(b.cross(c));
  if (!(std::fabs(volume) > 1e-9))
    throw Error(ErrorKind::input, "its primaries span no colours",
                "give the file chromaticities of a red, a green, a blue and a white");
  const Vec3d x = b.cross(c) / volume, y = c.cross(a) / volume, z = a.cross(b) / volume;
  return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

/// CIE XYZ with Y = 1.
Vec3d xyz_of(const Vec2f& xy) {
  if (!(std::fabs(xy.y) > 1e-6))
    throw Error(ErrorKind::input, "one of its primaries has no luminance",
                "give the file chromaticities of a red, a green, a blue and a white");
  const double x = xy.x, y = xy.y;
  return {x / y, 1, (1 - x - y) / y};
}

ColourMatrix xyz_from(const Primaries& p) {
  // A primary may have no luminance (the blue of ACES): by x, y, z then, scaled afterwards.
  const auto chromaticity = [](const Vec2f& xy) { return Vec3d(xy.x, xy.y, 1.0 - xy.x - xy.y); };
  const ColourMatrix m{{chromaticity(p.red), chromaticity(p.green), chromaticity(p.blue)}};
  return scaled(m, times(inverse(m), xyz_of(p.white)));
}

/// From XYZ under one white to XYZ under another.
ColourMatrix adaptation(const Vec2f& from, const Vec2f& to) {
  const ColourMatrix cones{
      {{0.8951, -0.7502, 0.0389}, {0.2664, 1.7135, -0.0685}, {-0.1614, 0.0367, 1.0296}}};
  const Vec3d seen = times(cones, xyz_of(from)), wanted = times(cones, xyz_of(to));
  return times(scaled(inverse(cones), wanted / seen), cones);
}

float distance(const Primaries& a, const Primaries& b) {
  return std::max({(a.red - b.red).length(), (a.green - b.green).length(),
                   (a.blue - b.blue).length(), (a.white - b.white).length()});
}

}  // namespace

Primaries rec709_primaries() {
  return {{0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}, {0.3127f, 0.3290f}};
}

std::optional<ColourMatrix> rec709_from(const Primaries& primaries) {
  const Primaries ours = rec709_primaries();
  if (distance(primaries, ours) <= 1e-3f) return std::nullopt;
  return times(inverse(xyz_from(ours)),
               times(adaptation(primaries.white, ours.white), xyz_from(primaries)));
}

}  // namespace kaustik
