#include "kaustik/base/wavelengths.h"

#include <array>
#include <cassert>

#include "kaustik/base/color.h"
#include "kaustik/base/reflectance_basis.h"

namespace kaustik {
namespace {

constexpr int first = int(Wavelengths::first_nm), last = int(Wavelengths::last_nm);
constexpr size_t knots = last - first + 1;  ///< one for each nm

/// The density of wavelengths but for a factor, 1/cosh²(steepness (λ − centre)), as in pbrt-v4:
/// smooth and small at both ends, so that few equidistant wavelengths integrate colours well.
constexpr double centre_nm = 538, steepness = 0.0072;
double quantile_scale(double nm) { return std::tanh(steepness * (nm - centre_nm)); }
const double lowest = quantile_scale(first), quantile_range = quantile_scale(last) - lowest;

double density(double nm) {
  const double cosh = std::cosh(steepness * (nm - centre_nm));
  return steepness / (cosh * cosh * quantile_range);
}

/// What is known of a wavelength.
struct Row {
  std::array<float, 3> basis;   ///< reflectances of red, green and blue
  float d65;                    ///< of the luminance 1
  std::array<float, 3> to_rgb;  ///< what a lane of one adds to red, green and blue
  float unused;                 ///< so that a row has 32 bytes
};

std::array<double, 3> basis_at(int nm) {
  const double at = double(nm - first) / 5;
  const size_t row = std::min(size_t(at), std::size(reflectance_basis_5nm) - 2);
  std::array<double, 3> result{};
  for (size_t i = 0; i < 3; ++i)
    result[i] = std::lerp(reflectance_basis_5nm[row][i], reflectance_basis_5nm[row + 1][i],
                          at - double(row));
  return result;
}

std::array<Row, knots> make_rows() {
  // ∫ of the eye's sensitivity and of what it sees of D65, in steps of 1 nm.
  double luminance_of_one = 0;
  Vec3d of_d65(0, 0, 0);
  for (int nm = first; nm <= last; ++nm) {
    luminance_of_one += cie_xyz_at(nm).y;
    of_d65 += cie_xyz_at(nm) * d65_at(nm);
  }
  const double d65_scale = luminance_of_one / of_d65.y;
  // The matrix to Rec. 709 has not quite the white of the tables.
  const Rgb white = rgb_from_xyz(of_d65 * (1 / of_d65.y));
  std::array<Row, knots> rows{};
  for (size_t i = 0; i < knots; ++i) {
    const int nm = first + int(i);
    const std::array<double, 3> basis = basis_at(nm);
    const Rgb seen = rgb_from_xyz(cie_xyz_at(nm));
    const double scale = 1 / (Spectrum::lane_count * density(nm) * luminance_of_one);
    rows[i] = {.basis = {float(basis[0]), float(basis[1]), float(basis[2])},
               .d65 = float(d65_at(nm) * d65_scale),
               .to_rgb = {float(seen.r * scale / white.r), float(seen.g * scale / white.g),
                          float(seen.b * scale / white.b)},
               .unused = 0};
  }
  return rows;
}

/// Between two rows of the table, for each lane.
class Rows {
 public:
  explicit Rows(const Wavelengths& wavelengths) {
    static const std::array<Row, knots> all = make_rows();
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      const float at = std::clamp(wavelengths[lane] - float(first), 0.0f, float(knots - 1));
      const size_t row = std::min(size_t(at), knots - 2);
      rows_[size_t(lane)] = &all[row];
      weights_.set(lane, at - float(row));
    }
  }
  /// Of each lane, `get` of its row.
  template <typename Get>
  Spectrum at_lanes(const Get& get) const {
    Spectrum low, high;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      low.set(lane, get(rows_[size_t(lane)][0]));
      high.set(lane, get(rows_[size_t(lane)][1]));
    }
    return low + (high - low) * weights_;
  }

 private:
  std::array<const Row*, size_t(Spectrum::lane_count)> rows_;
  Spectrum weights_;
};

}  // namespace

Wavelengths Wavelengths::spaced(float u) {
  const auto at = [u](float shift) {
    const float x = u + shift;
    const double quantile = double(x < 1 ? x : x - 1);
    const double nm = centre_nm + std::atanh(lowest + quantile_range * quantile) / steepness;
    return std::clamp(float(nm), first_nm, last_nm);
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
  if (lanes.is_zero()) return Spectrum();  // most components of most samples
  const Rows rows(wavelengths);
  const auto channel = [&](size_t i) {
    return (lanes * rows.at_lanes([i](const Row& row) { return row.to_rgb[i]; })).sum();
  };
  return spectrum_from_rgb(channel(0), channel(1), channel(2));
}

Spectrum reflectance_at_wavelengths(const Spectrum& rgb, const Wavelengths& wavelengths) {
  const Rows rows(wavelengths);
  Spectrum result = rgb[0] * rows.at_lanes([](const Row& row) { return row.basis[0]; });
  result += rgb[1] * rows.at_lanes([](const Row& row) { return row.basis[1]; });
  result += rgb[2] * rows.at_lanes([](const Row& row) { return row.basis[2]; });
  return result;
}

Spectrum d65_at_wavelengths(const Wavelengths& wavelengths) {
  return Rows(wavelengths).at_lanes([](const Row& row) { return row.d65; });
}

}  // namespace kaustik
