#pragma once
#include <cmath>

#include "kaustik/base/spectrum.h"

namespace kaustik {

/// Which light the lanes of a Spectrum hold: linear Rec. 709 red, green and blue (lane 3 is
/// unused), or four wavelengths. Whoever makes a spectrum or asks for one gets this as an argument.
/// Small, to be passed by value.
class Wavelengths {
 public:
  /// What can be seen and is rendered, nm.
  static constexpr float first_nm = 360, last_nm = 830;

  /// Red, green and blue.
  Wavelengths() : nm_{0, 0, 0, 0} {}
  /// Four wavelengths, nm, above zero.
  Wavelengths(float a, float b, float c, float d) : nm_{a, b, c, d} {}
  /// Four whose quantiles are a quarter apart, from `u` in [0, 1) on. Where `u` is uniform each
  /// lane has the same density over the visible range, which is highest at 538 nm and small at the
  /// ends.
  static Wavelengths spaced(float u);

  bool is_rgb() const { return nm_[0] == 0; }
  /// nm; also of a lane that carries no light any more. Not in RGB mode.
  float operator[](int lane) const { return std::fabs(nm_[lane]); }

  /// Whether light of that lane is still followed.
  bool is_alive(int lane) const { return nm_[lane] >= 0; }
  int alive_count() const { return is_alive(0) + is_alive(1) + is_alive(2) + is_alive(3); }
  /// The same after an event that sends each lane in a direction of its own: only `lane` goes on.
  /// Not in RGB mode.
  Wavelengths only(int lane) const;

  friend bool operator==(const Wavelengths& a, const Wavelengths& b) {
    return Spectrum(a.nm_) == Spectrum(b.nm_);
  }

 private:
  Spectrum::Register nm_;  ///< zeros: RGB; negative: the lane carries no light any more
};

/// Linear Rec. 709 (lane 3: zero) of light that arrives in these lanes. Of wavelengths it is an
/// estimate whose mean over Wavelengths::spaced(u) is the colour; the scale is that of
/// rgb_from_emission. The only way from lanes to colours: films and splats use it at their edge.
Spectrum rgb_from_wavelengths(const Spectrum& lanes, const Wavelengths& wavelengths);
inline Spectrum rgb_from_lanes(const Spectrum& lanes, const Wavelengths& wavelengths) {
  return wavelengths.is_rgb() ? lanes : rgb_from_wavelengths(lanes, wavelengths);
}

/// A reflectance (or another factor) of the linear Rec. 709 colour `rgb`. Of wavelengths: a mean of
/// its channels with weights that change smoothly (reflectance_basis.h), such that the colour under
/// D65 is exactly `rgb`. No value is below the least or above the largest of the channels.
Spectrum reflectance_at_wavelengths(const Spectrum& rgb, const Wavelengths& wavelengths);
inline Spectrum lanes_from_reflectance(const Spectrum& rgb, const Wavelengths& wavelengths) {
  return wavelengths.is_rgb() ? rgb : reflectance_at_wavelengths(rgb, wavelengths);
}

/// Light of the colour white: 1 in red, green and blue; D65 of the luminance 1.
Spectrum d65_at_wavelengths(const Wavelengths& wavelengths);
inline Spectrum white_light(const Wavelengths& wavelengths) {
  return wavelengths.is_rgb() ? spectrum_from_rgb(1, 1, 1) : d65_at_wavelengths(wavelengths);
}

/// Light of the linear Rec. 709 colour `rgb`: its reflectance under D65.
inline Spectrum lanes_from_emission(const Spectrum& rgb, const Wavelengths& wavelengths) {
  return wavelengths.is_rgb()
             ? rgb
             : reflectance_at_wavelengths(rgb, wavelengths) * d65_at_wavelengths(wavelengths);
}

}  // namespace kaustik
