#pragma once
#include "kaustik/base/wavelengths.h"

namespace kaustik {

/// How much light the lanes hold, as one number to compare and to learn by: the sum of red, green
/// and blue. Of wavelengths the sum of the lanes, in such a unit that white light has as much.
inline float lane_sum(const Spectrum& lanes, const Wavelengths& wavelengths) {
  if (wavelengths.is_rgb()) return lanes.sum();
  return 3 * lanes.sum() / white_light(wavelengths).sum();
}

}  // namespace kaustik
