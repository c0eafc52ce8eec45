#pragma once
#include "kaustik/base/photometric_units.h"

namespace kaustik {

/// Mitsuba's daylight over the physical one. Mitsuba's radiance is per nanometre, W/(sr·m²·nm): the
/// mean over wavelengths, weighted by how bright the eye sees them (CIE 1931; the integral of ȳ is
/// 106.857 nm). Physical radiance, in W/(sr·m²), has 179 lm/W. About 1/408.
inline constexpr double mitsuba_daylight = lumens_per_watt_white / (lumens_per_watt_555 * 106.857);

}  // namespace kaustik
