#pragma once
#include <atomic>
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

/// Adds to a sum, which stays at the end of its range rather than leaving it: as long as all that
/// is added has one sign, the order still makes no difference there.
inline void add_to(Fixed& sum, Fixed value) {
  if (__builtin_add_overflow(sum, value, &sum))
    sum = value < 0 ? -fixed_from(fixed_maximum) : fixed_from(fixed_maximum);
}

/// A Fixed that many threads add to. The two halves are added apart with a carry: the total is
/// exact once all additions have been made.
class AtomicFixed {
 public:
  void add(Fixed value) {
    const auto low = uint64_t(value);
    auto high = uint64_t(value >> 64);
    if (low != 0) {
      const uint64_t before = low_.fetch_add(low, std::memory_order_relaxed);
      if (before + low < before) ++high;
    }
    if (high != 0) high_.fetch_add(high, std::memory_order_relaxed);
  }
  /// Only when no one adds.
  Fixed load() const {
    return Fixed(UnsignedFixed(high_.load(std::memory_order_relaxed)) << 64 |
                 low_.load(std::memory_order_relaxed));
  }
  void clear() {
    low_.store(0, std::memory_order_relaxed);
    high_.store(0, std::memory_order_relaxed);
  }

 private:
  std::atomic<uint64_t> low_{0}, high_{0};
};

}  // namespace kaustik
