#pragma once
// Signed words of any width, one after the other without gaps.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "kaustik/base/exact_sum.h"
#include "kaustik/transport/picture_tiles.h"

namespace kaustik {

inline constexpr size_t words_per_line = PictureTiles::pixels;
/// Words of at most so many bits are read and written as one.
inline constexpr int most_narrow = 56;
/// Others have no more than these, and no bit of theirs stands for so much.
inline constexpr int most_wide = 120, top_of_words = 122;
/// Beyond what is read and written last.
inline constexpr size_t word_slack = 16;

template <typename T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <typename T>
void store(uint8_t* at, const T& value) {
  std::memcpy(at, &value, sizeof value);
}

/// Bits of a signed word.
inline int width_of(int64_t value) {
  return value == 0 ? 0 : 65 - std::countl_zero(uint64_t(value ^ (value >> 63)));
}

inline int width_of(Fixed value) {
  if (value == 0) return 0;
  const auto bits = UnsignedFixed(value ^ (value >> 127));
  const auto high = uint64_t(bits >> 64);
  return high ? 129 - std::countl_zero(high) : 65 - std::countl_zero(uint64_t(bits));
}

/// Of a number that is not 0.
inline int zeros_below(Fixed value) {
  const auto low = uint64_t(value);
  return low ? std::countr_zero(low) : 64 + std::countr_zero(uint64_t(UnsignedFixed(value) >> 64));
}

// `Word` is int64_t with up to most_narrow bits, or Fixed with up to most_wide.

template <typename Word>
Word word_at(const uint8_t* words, int width, size_t index) {
  using Unsigned = std::conditional_t<sizeof(Word) == 8, uint64_t, UnsignedFixed>;
  constexpr int bits = 8 * int(sizeof(Word));
  const size_t first = index * size_t(width);
  const auto from = Unsigned(load<Unsigned>(words + first / 8) >> (first % 8));
  return Word(from << (bits - width)) >> (bits - width);
}

using NarrowWords = std::array<int64_t, words_per_line>;  ///< of up to most_narrow bits
using WideWords = std::array<Fixed, words_per_line>;      ///< of up to most_wide

/// From `words_per_line · width` bits; reads up to `word_slack` bytes more.
void read_words(const uint8_t* from, int width, NarrowWords& words);
void read_words(const uint8_t* from, int width, WideWords& words);
/// Writes up to `word_slack` bytes more.
void write_words(const NarrowWords& words, int width, uint8_t* to);
void write_words(const WideWords& words, int width, uint8_t* to);

}  // namespace kaustik
