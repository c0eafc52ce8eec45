#pragma once

namespace kaustik {

// What scenes may be made of, in metres. Areas and densities are squares of lengths, volumes are
// cubes: within these single floats carry all three, from far below a wavelength to beyond Jupiter.

inline constexpr double largest_length = 1e12;    ///< of coordinates, sizes and distances
inline constexpr double smallest_length = 1e-12;  ///< of sizes

}  // namespace kaustik
