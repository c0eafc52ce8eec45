#pragma once
#include "kaustik/base/wavelengths.h"

namespace kaustik {

/// Factor on the plain sum of lanes in lane_sum(), for who asks for many of the same wavelengths.
inline float lane_sum_scale(const Wavelengths& wavelengths) {
  return wavelengths.is_rgb() ? 1.0f : 3 / white_light(wavelengths).sum();
}

/// How much light the lanes hold, as one number to compare and to learn by: the sum of red, green
/// and blue. Of wavelengths the sum of the lanes, in such a unit that white light has as much.
inline float lane_sum(const Spectrum& lanes, const Wavelengths& wavelengths) {
  return lanes.sum() * lane_sum_scale(wavelengths);
}

}  // namespace kaustik
