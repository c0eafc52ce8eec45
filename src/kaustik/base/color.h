#pragma once
// From measured curves to colours. Conversion happens only at the edges: textures, lights, film.

#include <variant>

#include "kaustik/base/parameters.h"
#include "kaustik/base/spectrum.h"

namespace kaustik {

/// CIE 1931 2° observer at a wavelength in nm; zero outside 360–830.
Vec3d cie_xyz_at(double wavelength_nm);
/// Relative spectral power of CIE D65 (100 at 560 nm); zero outside 300–830.
double d65_at(double wavelength_nm);
Rgb rgb_from_xyz(const Vec3d& xyz);

/// Linear Rec. 709 of a reflectance (or another factor) curve under D65: one that is c from 360 to
/// 830 nm gives (c, c, c). Beyond its ends it is zero. Colours outside the gamut are clamped to
/// zero.
Rgb rgb_from_reflectance(const SpectralCurve& curve);
/// Linear Rec. 709 of an emission curve, zero beyond its ends; one that is c from 360 to 830 nm has
/// the luminance c and the colour of equal energy, c · (1.2048, 0.9483, 0.9089), as in Mitsuba's
/// RGB mode.
Rgb rgb_from_emission(const SpectralCurve& curve);

/// What a `color` argument means for something that reflects or for something that emits.
Spectrum reflectance_spectrum(const std::variant<Rgb, SpectralCurve>& color);
Spectrum emission_spectrum(const std::variant<Rgb, SpectralCurve>& color);

}  // namespace kaustik
