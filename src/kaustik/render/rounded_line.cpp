#include "kaustik/render/rounded_line.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace kaustik {
namespace {

constexpr int exponent_bias = 1023, mantissa_bits = 52;

/// Mean of the binary exponents of those that are not zero, rounded down; false: all are.
template <typename Number>
bool mean_exponent(const std::array<Number, PictureTiles::pixels>& values, int& mean) {
  int sum = 0, count = 0;
  for (const Number value : values) {
    const auto exponent = int(std::bit_cast<uint64_t>(double(value)) >> mantissa_bits & 0x7ff);
    sum += exponent;
    count += exponent != 0 ? 1 : 0;
  }
  if (count == 0) return false;
  mean = sum / count - exponent_bias;
  return true;
}

}  // namespace

template <typename Number>
void round_line(std::array<Number, PictureTiles::pixels>& values, int bits) {
  int mean = 0;
  if (!mean_exponent(values, mean)) return;
  // In its neighbourhood doubles are the multiples; sums are rounded to the nearest, to even ones
  // where two are as near.
  const double neighbourhood = std::ldexp(1.5, mean - bits + mantissa_bits);
  for (Number& value : values) value = Number(double(value) + neighbourhood - neighbourhood);
}

template void round_line(std::array<float, PictureTiles::pixels>&, int);
template void round_line(std::array<double, PictureTiles::pixels>&, int);

}  // namespace kaustik
