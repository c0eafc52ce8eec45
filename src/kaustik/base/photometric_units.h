#pragma once

namespace kaustik {

/// Of light of 555 nm: the definition of the lumen.
inline constexpr double lumens_per_watt_555 = 683;
/// Of white light, the convention of lighting simulation (Radiance's WHTEFFICACY): what turns W/m²
/// into lx, and W/(sr·m²) into cd/m².
inline constexpr double lumens_per_watt_white = 179;

}  // namespace kaustik
