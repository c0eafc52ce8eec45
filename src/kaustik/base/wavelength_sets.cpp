#include "kaustik/base/wavelength_sets.h"

#include <cassert>
#include <cmath>

namespace kaustik {
namespace {

constexpr auto lanes = double(Spectrum::lane_count);

/// Of the bits of an index in reverse, in [0, 1).
double radical_inverse(uint32_t index) {
  double result = 0;
  for (double digit = 0.5; index != 0; index >>= 1, digit /= 2)
    if (index & 1) result += digit;
  return result;
}

/// Where a seed's wavelengths begin, in [0, 1).
double shift_of(uint64_t seed) {
  // Weyl's sequence: near seeds lie far apart.
  constexpr double golden = 0.6180339887498949;
  return std::fmod(double(seed % 1000003) * golden, 1.0);
}

}  // namespace

WavelengthSets WavelengthSets::of_pass(uint64_t seed, uint32_t pass, size_t count) {
  assert(count >= 1 && count <= most);
  const double step = 1 / (lanes * double(count));
  // The numbers of regional passes have the highest bit.
  const double first = (shift_of(seed) + radical_inverse(pass & 0x7fffffff)) * step;
  WavelengthSets result;
  result.count_ = count;
  result.are_given_ = false;
  Spectrum white;
  for (size_t set = 0; set < count; ++set) {
    const double quantile = std::fmod(first + double(set) * step, 1 / lanes);
    result.sets_[set] = Wavelengths::spaced(float(quantile));
    white += rgb_from_lanes(white_light(result.sets_[set]), result.sets_[set]) / float(count);
  }
  if (count == most) result.balance_ = Spectrum(1 / white[0], 1 / white[1], 1 / white[2], 1);
  return result;
}

}  // namespace kaustik
