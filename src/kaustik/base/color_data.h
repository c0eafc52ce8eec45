#pragma once
// The tables behind color.h, which is what to use.

namespace kaustik {

/// x̄, ȳ, z̄ of the CIE 1931 2° observer from 360 to 830 nm in steps of 5.
extern const double cie1931_5nm[95][3];
/// Relative power of illuminant D65 from 300 to 830 nm in steps of 5.
extern const double d65_5nm[107];

}  // namespace kaustik
