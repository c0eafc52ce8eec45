#pragma once
// The arithmetic of Sampler: in a header because it runs for every dimension of every path.
#include <array>
#include <cstddef>
#include <cstdint>

namespace kaustik::sampler_details {

/// Numbers that the same is done to.
using Words = uint32_t __attribute__((vector_size(16)));

/// Of every byte by itself.
template <typename Word>
constexpr Word reverse_bits_of_bytes(Word x) {
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}
constexpr uint32_t reverse_bits(uint32_t x) { return reverse_bits_of_bytes(__builtin_bswap32(x)); }
inline Words reverse_bits(Words x) {
  using Bytes = uint8_t __attribute__((vector_size(16)));
  const auto bytes = Bytes(x);
  return reverse_bits_of_bytes(Words(
      __builtin_shufflevector(bytes, bytes, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12)));
}

/// Laine–Karras permutation with the constants found by Vegdahl: an Owen scramble of bits that
/// stand in reversed order.
template <typename Word>
constexpr Word owen_hash_reversed(Word x, Word seed) {
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
inline constexpr auto sobol_tables = make_sobol_tables();

inline uint32_t sobol_second_reversed(uint32_t reversed_index) {
  return sobol_tables[0][reversed_index & 255] ^ sobol_tables[1][reversed_index >> 8 & 255] ^
         sobol_tables[2][reversed_index >> 16 & 255] ^ sobol_tables[3][reversed_index >> 24];
}

inline float to_unit(uint32_t x) { return float(x >> 8) * 0x1p-24f; }

}  // namespace kaustik::sampler_details
