#include "kaustik/base/sampler.h"

#include <array>

namespace kaustik {
namespace {

constexpr uint32_t reverse_bits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// Laine–Karras permutation with the constants found by Vegdahl: an Owen scramble of bits that
/// stand in reversed order.
constexpr uint32_t owen_hash_reversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Sobol's second dimension (direction numbers: Pascal's triangle modulo 2) per byte: index and
/// result both with their bits reversed, which is the form that scrambling works on. The product of
/// matrix and index is the exclusive or of four table entries.
constexpr auto make_sobol_tables() {
  std::array<std::array<uint32_t, 256>, 4> tables{};
  std::array<uint32_t, 32> directions{};
  directions[0] = 0x80000000u;
  for (size_t i = 1; i < 32; ++i) directions[i] = directions[i - 1] ^ (directions[i - 1] >> 1);
  for (size_t byte = 0; byte < 4; ++byte)
    for (size_t value = 0; value < 256; ++value) {
      uint32_t x = 0;
      for (size_t bit = 0; bit < 8; ++bit)
        if (value >> bit & 1) x ^= directions[31 - (byte * 8 + bit)];
      tables[byte][value] = reverse_bits(x);
    }
  return tables;
}
constexpr auto sobol_tables = make_sobol_tables();

uint32_t sobol_second_reversed(uint32_t reversed_index) {
  return sobol_tables[0][reversed_index & 255] ^ sobol_tables[1][reversed_index >> 8 & 255] ^
         sobol_tables[2][reversed_index >> 16 & 255] ^ sobol_tables[3][reversed_index >> 24];
}

float to_unit(uint32_t x) { return float(x >> 8) * 0x1p-24f; }

}  // namespace

Sampler::Sampler(uint64_t scramble, uint32_t index)
    : scramble_(scramble), index_(index), reversed_index_(reverse_bits(index)) {}

Vec2f Sampler::next_2d() {
  const uint32_t pair = pair_++;
  const uint64_t h = hash_mix(scramble_, pair);
  if (pair >= stratified_pairs) {
    const uint64_t r = hash_mix(h, index_);
    return {to_unit(uint32_t(r)), to_unit(uint32_t(r >> 32))};
  }
  // The shuffle of the index is itself an Owen scramble, so any run of 2^k indices stays a net.
  const uint32_t reversed = owen_hash_reversed(reversed_index_, uint32_t(h));
  const uint64_t seeds = h * 0xd1342543de82ef95ull + 1;
  // The first Sobol dimension is the bit reversal of the index: reversed once more, the index.
  const uint32_t x = reverse_bits(owen_hash_reversed(reverse_bits(reversed), uint32_t(h >> 32)));
  const uint32_t y =
      reverse_bits(owen_hash_reversed(sobol_second_reversed(reversed), uint32_t(seeds >> 32)));
  return {to_unit(x), to_unit(y)};
}

}  // namespace kaustik
