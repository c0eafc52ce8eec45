#include "kaustik/loader/pbrt/colour_space.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/color.h"

namespace kaustik::pbrt {
namespace {

using Matrix = Imath::M33d;  // rows

/// Chromaticities of the primaries and of white.
struct Chromaticities {
  double red[2], green[2], blue[2], white[2];
};

constexpr double d65_white[2] = {0.3127, 0.3290};

const Chromaticities& chromaticities(ColourSpace space) {
  static const Chromaticities srgb{{.64, .33}, {.3, .6}, {.15, .06}, {d65_white[0], d65_white[1]}};
  static const Chromaticities rec2020{
      {.708, .292}, {.170, .797}, {.131, .046}, {d65_white[0], d65_white[1]}};
  static const Chromaticities dci_p3{
      {.680, .320}, {.265, .690}, {.150, .060}, {d65_white[0], d65_white[1]}};
  static const Chromaticities aces{{.7347, .2653}, {0., 1.}, {.0001, -.077}, {.32168, .33767}};
  switch (space) {
    case ColourSpace::srgb:
      return srgb;
    case ColourSpace::rec2020:
      return rec2020;
    case ColourSpace::dci_p3:
      return dci_p3;
    case ColourSpace::aces:
      return aces;
  }
  return srgb;
}

Vec3d xyz_of(const double (&xy)[2]) { return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]}; }

/// Of columns.
Matrix matrix(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z};
}

Vec3d apply(const Matrix& m, const Vec3d& v) {
  Vec3d result;
  for (int i = 0; i < 3; ++i) result[i] = m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z;
  return result;
}

/// Its primaries add up to its white, of luminance 1.
Matrix xyz_from(ColourSpace space) {
  const Chromaticities& c = chromaticities(space);
  const Vec3d r = xyz_of(c.red), g = xyz_of(c.green), b = xyz_of(c.blue);
  const Vec3d amounts = apply(matrix(r, g, b).inverse(), xyz_of(c.white));
  return matrix(r * amounts.x, g * amounts.y, b * amounts.z);
}

Matrix rec709_from(ColourSpace space) {
  return xyz_from(ColourSpace::srgb).inverse() * xyz_from(space);
}

Rgb rgb_of(const Vec3d& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::optional<ColourSpace> colour_space_named(std::string_view name) {
  if (name == "srgb") return ColourSpace::srgb;
  if (name == "rec2020") return ColourSpace::rec2020;
  if (name == "dci-p3") return ColourSpace::dci_p3;
  if (name == "aces2065-1") return ColourSpace::aces;
  return std::nullopt;
}

Rgb light_from(ColourSpace space, const Rgb& colour) {
  if (space == ColourSpace::srgb) return colour;
  return rgb_of(apply(rec709_from(space), {colour.r, colour.g, colour.b}));
}

Rgb reflectance_from(ColourSpace space, const Rgb& colour) {
  if (space == ColourSpace::srgb) return colour;
  const Matrix m = rec709_from(space);
  Vec3d result = apply(m, {colour.r, colour.g, colour.b});
  const Vec3d white = apply(m, {1, 1, 1});
  for (int i = 0; i < 3; ++i) result[i] /= white[i];
  return rgb_of(result);
}

double luminance(const Rgb& colour) {
  return 0.212639 * colour.r + 0.715169 * colour.g + 0.072192 * colour.b;
}

double luminance(const SpectralCurve& light) {
  double sum = 0, whole = 0;
  size_t next = 0;
  const auto& samples = light.samples;
  for (int nm = 360; nm <= 830; ++nm) {
    const double weight = cie_xyz_at(nm).y;
    whole += weight;
    while (next < samples.size() && samples[next].first <= nm) ++next;
    if (next == 0 || samples.empty()) continue;
    if (next == samples.size()) {
      if (samples.back().first == nm) sum += weight * samples.back().second;
      continue;
    }
    const auto& [low_nm, low] = samples[next - 1];
    const auto& [high_nm, high] = samples[next];
    sum += weight * (low + (high - low) * (nm - low_nm) / (high_nm - low_nm));
  }
  return sum / whole;
}

SpectralCurve blackbody_curve(double kelvin) {
  constexpr double c1 = 1.191042972e-16;           // 2hc², W m²/sr
  constexpr double c2 = 1.438776877e-2;            // hc/k, m K
  constexpr double displacement = 2.897771955e-3;  // Wien's, m K
  const auto radiance = [&](double metres) {
    return c1 / (std::pow(metres, 5) * std::expm1(c2 / (metres * kelvin)));
  };
  const double most = radiance(displacement / kelvin);
  SpectralCurve curve;
  for (int nm = 360; nm <= 830; nm += 5) curve.samples.emplace_back(nm, radiance(nm * 1e-9) / most);
  return curve;
}

}  // namespace kaustik::pbrt
