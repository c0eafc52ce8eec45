#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace kaustik {

/// Takes up to eight digits off the front of a text; `value` is their number. Returns how many they
/// are; after eight there may be more.
inline int take_digits(const char*& at, const char* end, uint32_t& value) {
  if (end - at < 8 || std::endian::native != std::endian::little) {
    const char* const first = at;
    for (value = 0; at != end && at - first < 8 && *at >= '0' && *at <= '9'; ++at)
      value = 10 * value + uint32_t(*at - '0');
    return int(at - first);
  }
  // All at once, a byte each: numbers of digits vary too much to be guessed by branches.
  uint64_t bytes;
  std::memcpy(&bytes, at, sizeof(bytes));
  bytes ^= 0x3030303030303030;
  // The highest bit of each that is above 9; of those behind the first one it does not matter.
  const uint64_t others = ((bytes + 0x7676767676767676) | bytes) & 0x8080808080808080;
  const int count = std::countr_zero(others) / 8;
  if (count == 0) {
    value = 0;
    return 0;
  }
  // Zeros before them, then pairs, then fours, then all.
  bytes <<= 8 * (8 - count);
  bytes = bytes * 10 + (bytes >> 8);
  constexpr uint64_t mask = 0x000000ff000000ff;
  value = uint32_t(
      ((bytes & mask) * 0x000f424000000064 + ((bytes >> 16) & mask) * 0x0000271000000001) >> 32);
  at += count;
  return count;
}

/// Takes a number in plain decimal notation off the front of `text`, such as -12.375: digits, a
/// point with digits behind it, a minus sign. `value` is the double nearest to it, as
/// std::from_chars() gives it, in less time. False, and nothing taken: something else stands there,
/// such as an exponent, or eight digits in a row.
inline bool take_decimal(std::string_view& text, double& value) {
  // Both are doubles without rounding, so their quotient is rounded once (Clinger, "How to Read
  // Floating Point Numbers Accurately", PLDI 1990).
  constexpr double powers_of_ten[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
  const char* at = text.data();
  const char* const end = at + text.size();
  const bool is_negative = at != end && *at == '-';
  at += is_negative ? 1 : 0;
  uint32_t whole = 0, fraction = 0;
  int digits = 0;
  if (const int before = take_digits(at, end, whole); before == 0 || before == 8) return false;
  if (at != end && *at == '.') {
    digits = take_digits(++at, end, fraction);
    if (digits == 0 || digits == 8) return false;
  }
  if (at != end && (*at == 'e' || *at == 'E')) return false;
  const double power = powers_of_ten[digits];
  value = (double(whole) * power + double(fraction)) / power;
  if (is_negative) value = -value;
  text.remove_prefix(size_t(at - text.data()));
  return true;
}

}  // namespace kaustik
