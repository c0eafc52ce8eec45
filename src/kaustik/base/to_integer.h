#pragma once
#include <cmath>
#include <concepts>
#include <cstdint>

namespace kaustik {

// A cast of a floating-point number that is too large for its integer, or no number at all, is
// undefined. Wherever such a number can come from a scene or from rounding, this is used instead.

/// `value` without its fraction, within `low` and `high`; `low` for what is no number. `low` must
/// be a number that Float holds.
template <std::integral Integer, std::floating_point Float>
constexpr Integer to_integer(Float value, Integer low, Integer high) {
  if (!(value > Float(low))) return low;
  // Float(high) may be rounded up, to one more than there is, but then all below it fits.
  return value < Float(high) ? Integer(value) : high;
}

/// The cell of a lattice of unit cells that `value` lies in. Cells end at ±2^30, where floats have
/// no fractions left and neighbours of the last can still be counted.
inline int lattice_cell(float value) {
  constexpr int last = 1 << 30;
  return to_integer(std::floor(value), -last, last);
}

}  // namespace kaustik
