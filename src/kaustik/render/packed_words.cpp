#include "kaustik/render/packed_words.h"

#include <utility>

namespace kaustik {
namespace {

/// Eight narrow words at a time, which fill whole bytes: so all shifts are known here.
template <size_t width>
struct EightWords {
  static void read(const uint8_t* from, int64_t* words) {
    for (size_t group = 0; group < words_per_line / 8; ++group, from += width, words += 8)
      [&]<size_t... i>(std::index_sequence<i...>) {
        ((words[i] =
              int64_t(load<uint64_t>(from + i * width / 8) << (64 - width - i * width % 8)) >>
              (64 - width)),
         ...);
      }
    (std::make_index_sequence<8>());
  }
  static void write(const int64_t* words, uint8_t* to) {
    constexpr uint64_t mask = (uint64_t(1) << width) - 1;
    for (size_t group = 0; group < words_per_line / 8; ++group, to += width, words += 8)
      [&]<size_t... i>(std::index_sequence<i...>) {
        uint64_t waiting = 0;
        ((waiting = waiting >> (i * width / 8 - (i - (i > 0)) * width / 8) * 8 |
                    (uint64_t(words[i]) & mask) << i * width % 8,
          store(to + i * width / 8, waiting)),
         ...);
      }
    (std::make_index_sequence<8>());
  }
};

}  // namespace

void read_words(const uint8_t* from, int width, NarrowWords& words) {
  static constexpr auto readers = []<size_t... i>(std::index_sequence<i...>) {
    return std::array{EightWords<i + 1>::read...};
  }
  (std::make_index_sequence<most_narrow>());
  readers[size_t(width - 1)](from, words.data());
}

void write_words(const NarrowWords& words, int width, uint8_t* to) {
  static constexpr auto writers = []<size_t... i>(std::index_sequence<i...>) {
    return std::array{EightWords<i + 1>::write...};
  }
  (std::make_index_sequence<most_narrow>());
  writers[size_t(width - 1)](words.data(), to);
}

void read_words(const uint8_t* from, int width, WideWords& words) {
  for (size_t i = 0; i < words_per_line; ++i) words[i] = word_at<Fixed>(from, width, i);
}

void write_words(const WideWords& words, int width, uint8_t* to) {
  const UnsignedFixed mask = (UnsignedFixed(1) << width) - 1;
  UnsignedFixed waiting = 0;
  int waiting_bits = 0;  // fewer than 8
  for (const Fixed word : words) {
    waiting |= (UnsignedFixed(word) & mask) << waiting_bits;
    waiting_bits += width;
    store(to, waiting);
    to += waiting_bits / 8;
    waiting >>= waiting_bits / 8 * 8;
    waiting_bits %= 8;
  }
}

}  // namespace kaustik
