#pragma once
// The table behind lanes_from_reflectance(), which is what to use.

namespace kaustik {

/// Reflectances whose colours under D65 are red, green and blue of Rec. 709, from 360 to 830 nm in
/// steps of 5. They add up to 1 at every wavelength.
extern const double reflectance_basis_5nm[95][3];

}  // namespace kaustik
