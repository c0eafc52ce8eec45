#pragma once
// What the descriptions of media have in common.

#include "kaustik/base/spectral_value.h"
#include "kaustik/medium/medium.h"

namespace kaustik {

/// A colour as a factor; in RGB mode the lane that carries no light gets the mean of the others,
/// which makes it harmless where lanes are sampled.
SpectralValue coefficient(const std::variant<Rgb, SpectralCurve>& color);

/// The parameter of that name as a coefficient, given as a value or as a volume that is the same
/// everywhere. Throws Error(input) if it is given as both, or out of its range.
SpectralValue coefficient(const MediumInputs& inputs, std::string_view name);

/// The grid that is given for that parameter; null: it is the same everywhere. Throws Error(input)
/// if it is given as a value, too.
const GridVolume* given_grid(const MediumInputs& inputs, std::string_view name);

/// Throws Error(input) if light would have to fly a distance that floats do not carry.
void check_extinction(const Spectrum& extinction, const Arguments& arguments);

// The rows `albedo`, `sigma_t` and `scale`.
Parameter albedo_parameter();
Parameter sigma_t_parameter();
Parameter medium_scale_parameter();

/// Throws Error(input) unless the grid is one of albedos.
void check_albedo_grid(const GridVolume& grid, const Place& place);

}  // namespace kaustik
