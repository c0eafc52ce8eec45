#include "kaustik/base/wavelengths.h"

#include <array>
#include <cassert>

#include "kaustik/base/color.h"

namespace kaustik {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Ends of the two lower bands, nm. Between them each band's colour under D65 lies outside of
/// Rec. 709, so that every colour of Rec. 709 is a mean of the three.
constexpr double last_blue_nm = 493.5, last_green_nm = 590.5;

int band_of(double nm) { return nm < last_blue_nm ? 0 : nm < last_green_nm ? 1 : 2; }

/// What a band reflects, as channels.
std::array<double, 3> channels_of_band(int band) {
  std::array<double, 3> sum{}, all{};
  for (int nm = int(Wavelengths::first_nm); nm <= int(Wavelengths::last_nm); ++nm) {
    const Rgb c = rgb_from_xyz(cie_xyz_at(nm) * d65_at(nm));
    const std::array<double, 3> channels = {c.r, c.g, c.b};
    for (size_t i = 0; i < 3; ++i) {
      all[i] += channels[i];
      if (band_of(nm) == band) sum[i] += channels[i];
    }
  }
  for (size_t i = 0; i < 3; ++i) sum[i] /= all[i];
  return sum;
}

/// By Cramer's rule.
Matrix inverse(const Matrix& m) {
  Matrix result;
  const auto minor = [&](size_t r, size_t c) {
    const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) result[r][c] = minor(c, r) / det;
  return result;
}

/// Row by row what a band reflects of red, green and blue: shares, at least 0, that add up to 1.
const Matrix& bands() {
  static const Matrix shares = [] {
    Matrix channels;
    for (int band = 0; band < 3; ++band) {
      const auto c = channels_of_band(band);
      for (size_t i = 0; i < 3; ++i) channels[i][size_t(band)] = c[i];
    }
    return inverse(channels);
  }();
  return shares;
}

/// ∫ of the eye's sensitivity, in steps of 1 nm.
double luminance_of_one() {
  static const double integral = [] {
    double sum = 0;
    for (int nm = int(Wavelengths::first_nm); nm <= int(Wavelengths::last_nm); ++nm)
      sum += cie_xyz_at(nm).y;
    return sum;
  }();
  return integral;
}

double luminance_of_d65() {
  static const double integral = [] {
    double sum = 0;
    for (int nm = int(Wavelengths::first_nm); nm <= int(Wavelengths::last_nm); ++nm)
      sum += cie_xyz_at(nm).y * d65_at(nm);
    return sum;
  }();
  return integral;
}

constexpr float range_nm = Wavelengths::last_nm - Wavelengths::first_nm;

}  // namespace

Wavelengths Wavelengths::spaced(float u) {
  const auto at = [u](float shift) {
    const float x = u + shift;
    return first_nm + range_nm * (x < 1 ? x : x - 1);
  };
  return {at(0), at(0.25f), at(0.5f), at(0.75f)};
}

Wavelengths Wavelengths::only(int lane) const {
  assert(!is_rgb());
  Wavelengths result = *this;
  for (int i = 0; i < Spectrum::lane_count; ++i)
    if (i != lane) result.nm_[i] = -(*this)[i];
  return result;
}

Spectrum rgb_from_wavelengths(const Spectrum& lanes, const Wavelengths& wavelengths) {
  Vec3d xyz(0, 0, 0);
  for (int i = 0; i < Spectrum::lane_count; ++i)
    xyz += cie_xyz_at(double(wavelengths[i])) * double(lanes[i]);
  const Rgb c =
      rgb_from_xyz(xyz * (double(range_nm) / (Spectrum::lane_count * luminance_of_one())));
  return spectrum_from_rgb(float(c.r), float(c.g), float(c.b));
}

Spectrum reflectance_at_wavelengths(const Spectrum& rgb, const Wavelengths& wavelengths) {
  Spectrum result;
  for (int i = 0; i < Spectrum::lane_count; ++i) {
    const std::array<double, 3>& share = bands()[size_t(band_of(double(wavelengths[i])))];
    result.set(i, float(share[0] * double(rgb[0]) + share[1] * double(rgb[1]) +
                        share[2] * double(rgb[2])));
  }
  return result;
}

Spectrum d65_at_wavelengths(const Wavelengths& wavelengths) {
  Spectrum result;
  const double scale = luminance_of_one() / luminance_of_d65();
  for (int i = 0; i < Spectrum::lane_count; ++i)
    result.set(i, float(d65_at(double(wavelengths[i])) * scale));
  return result;
}

}  // namespace kaustik
