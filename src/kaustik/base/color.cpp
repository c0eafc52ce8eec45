#include "kaustik/base/color.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/base/color_data.h"

namespace kaustik {
namespace {

constexpr int first_visible_nm = 360, last_visible_nm = 830;

/// Where a wavelength lies in a table of 5 nm steps: the row before it and the weight of the next.
struct TablePosition {
  size_t row;
  double weight;
};

TablePosition position_in_table(double wavelength_nm, double first_nm, size_t rows) {
  const double at = (wavelength_nm - first_nm) / 5;
  const size_t row = std::min(size_t(at), rows - 2);
  return {row, at - double(row)};
}

/// Sum over the visible range in steps of 1 nm of weight(λ) · (x̄, ȳ, z̄)(λ).
template <typename Weight>
Vec3d integrate_xyz(const Weight& weight) {
  Vec3d sum(0, 0, 0);
  for (int nm = first_visible_nm; nm <= last_visible_nm; ++nm) sum += cie_xyz_at(nm) * weight(nm);
  return sum;
}

Rgb without_negatives(const Rgb& c) {
  return {std::max(0.0, c.r), std::max(0.0, c.g), std::max(0.0, c.b)};
}

/// Values of a curve at ascending wavelengths, each asked for once; zero beyond its ends.
class CurveReader {
 public:
  explicit CurveReader(const SpectralCurve& curve) : samples_(curve.samples) {}
  double operator()(double nm) {
    while (next_ < samples_.size() && samples_[next_].first <= nm) ++next_;
    if (samples_.empty()) return 0;
    if (next_ == 0) return 0;
    if (next_ == samples_.size()) return samples_.back().first == nm ? samples_.back().second : 0;
    const auto& [low_nm, low] = samples_[next_ - 1];
    const auto& [high_nm, high] = samples_[next_];
    return low + (high - low) * (nm - low_nm) / (high_nm - low_nm);
  }

 private:
  const std::vector<std::pair<double, double>>& samples_;
  size_t next_ = 0;
};

Spectrum spectrum_of(const Rgb& c) { return spectrum_from_rgb(float(c.r), float(c.g), float(c.b)); }

}  // namespace

Vec3d cie_xyz_at(double wavelength_nm) {
  if (!(wavelength_nm >= first_visible_nm && wavelength_nm <= last_visible_nm))
    return Vec3d(0, 0, 0);
  const auto [row, weight] =
      position_in_table(wavelength_nm, first_visible_nm, std::size(cie1931_5nm));
  const auto& a = cie1931_5nm[row];
  const auto& b = cie1931_5nm[row + 1];
  return {std::lerp(a[0], b[0], weight), std::lerp(a[1], b[1], weight),
          std::lerp(a[2], b[2], weight)};
}

double d65_at(double wavelength_nm) {
  if (!(wavelength_nm >= 300 && wavelength_nm <= 830)) return 0;
  const auto [row, weight] = position_in_table(wavelength_nm, 300, std::size(d65_5nm));
  return std::lerp(d65_5nm[row], d65_5nm[row + 1], weight);
}

Rgb rgb_from_xyz(const Vec3d& c) {
  return {3.2404541621 * c.x - 1.5371385128 * c.y - 0.4985314096 * c.z,
          -0.9692660305 * c.x + 1.8760108454 * c.y + 0.0415560175 * c.z,
          0.0556434310 * c.x - 0.2040259135 * c.y + 1.0572251882 * c.z};
}

Rgb rgb_from_reflectance(const SpectralCurve& curve) {
  static const Rgb white = rgb_from_xyz(integrate_xyz([](double nm) { return d65_at(nm); }));
  CurveReader value(curve);
  const Rgb c = rgb_from_xyz(integrate_xyz([&](double nm) { return value(nm) * d65_at(nm); }));
  return without_negatives({c.r / white.r, c.g / white.g, c.b / white.b});
}

Rgb rgb_from_emission(const SpectralCurve& curve) {
  static const double luminance_of_one = integrate_xyz([](double) { return 1.0; }).y;
  CurveReader value(curve);
  return without_negatives(
      rgb_from_xyz(integrate_xyz([&](double nm) { return value(nm); }) / luminance_of_one));
}

Spectrum reflectance_spectrum(const std::variant<Rgb, SpectralCurve>& color) {
  if (const auto* curve = std::get_if<SpectralCurve>(&color))
    return spectrum_of(rgb_from_reflectance(*curve));
  return spectrum_of(std::get<Rgb>(color));
}

Spectrum emission_spectrum(const std::variant<Rgb, SpectralCurve>& color) {
  if (const auto* curve = std::get_if<SpectralCurve>(&color))
    return spectrum_of(rgb_from_emission(*curve));
  return spectrum_of(std::get<Rgb>(color));
}

}  // namespace kaustik
