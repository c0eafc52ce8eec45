#pragma once
#include <cmath>
#include <cstdint>

namespace kaustik {

/// Wide fixed-point number: 64 integer bits (one of them the sign) and 64 fraction bits. Adding is
/// exact and associative, so sums over passes, threads and machines have the same bits in any
/// order.
__extension__ using Fixed = __int128;
__extension__ using UnsignedFixed = unsigned __int128;

inline constexpr double fixed_maximum = 9.2e18;

/// `value` must be finite; magnitudes beyond ±9.2e18 are cut there.
inline Fixed fixed_from(double value) {
  if (value < 0) return -fixed_from(-value);
  if (value > fixed_maximum) value = fixed_maximum;
  // Exact: a double has 53 bits, so splitting off the integer part loses nothing; fractions below
  // 2^-64 are rounded toward zero.
  const double whole = std::floor(value);
  const double fraction = (value - whole) * 0x1p64;
  return (Fixed(int64_t(whole)) << 64) + Fixed(uint64_t(fraction < 0x1p64 ? fraction : 0));
}

inline double double_from(Fixed value) {
  if (value < 0) return -double_from(-value);
  return double(int64_t(value >> 64)) + double(uint64_t(value)) * 0x1p-64;
}

/// The largest sum; the least is its opposite.
inline constexpr Fixed fixed_limit = Fixed(int64_t(fixed_maximum)) << 64;

/// Adds to a sum, which stays at the end of its range rather than leaving it: as long as all that
/// is added has one sign, the order makes no difference there either.
inline void add_to(Fixed& sum, Fixed value) {
  if (__builtin_add_overflow(sum, value, &sum))
    sum = value < 0 ? -fixed_limit : fixed_limit;
  else if (sum > fixed_limit || sum < -fixed_limit)
    sum = sum < 0 ? -fixed_limit : fixed_limit;
}

}  // namespace kaustik
