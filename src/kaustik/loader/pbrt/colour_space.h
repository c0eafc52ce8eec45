#pragma once
// The colour spaces of pbrt, taken to linear Rec. 709, and luminances of light.

#include <optional>
#include <string_view>

#include "kaustik/base/parameters.h"

namespace kaustik::pbrt {

/// Those of the directive ColorSpace.
enum class ColourSpace : uint8_t { srgb, rec2020, dci_p3, aces };

/// Nothing: pbrt has none of that name.
std::optional<ColourSpace> colour_space_named(std::string_view name);

/// Linear Rec. 709 of a colour that lights up. Colours beyond it may have negative parts.
Rgb light_from(ColourSpace space, const Rgb& colour);
/// The same of what reflects, whose white is white whatever the light: rows sum to one.
Rgb reflectance_from(ColourSpace space, const Rgb& colour);

/// Of linear Rec. 709, and of a curve: one that is c from 360 to 830 nm has the luminance c.
double luminance(const Rgb& colour);
double luminance(const SpectralCurve& light);

/// Planck's law at a temperature in K, from 360 to 830 nm, with the maximum over all wavelengths
/// as 1 (pbrt's normalised blackbody).
SpectralCurve blackbody_curve(double kelvin);

}  // namespace kaustik::pbrt
