#pragma once
// The sums of one number of all pixels of a tile as they are packed: a header, words, and what is
// set aside.

#include <optional>

#include "kaustik/render/split_words.h"

namespace kaustik {

/// A sum of Fixed that has no limit.
struct WideSum {
  uint64_t fraction = 0;
  Fixed whole = 0;
  void add(Fixed value);
  void add(const WideSum& other);
  /// Cut at ±fixed_limit.
  Fixed cut() const;
};

/// Of a number that is set aside: its place (u16), fraction and whole part (u64 each). Where that
/// is not all, the place has this bit, and another such entry holds what is above.
inline constexpr size_t entry_bytes = 18;
inline constexpr int set_aside_bits = 8 * int(entry_bytes);
inline constexpr uint16_t has_more = 0x8000;

struct LineHeader {
  uint8_t packed_width = 0;  ///< bits of a word, and `split_line` if words are split
  uint8_t shift = 0;
  /// Entries of what is set aside (10 bits), numbers that were when the window was chosen (6 bits,
  /// at most 63); or `uniform_line`.
  uint16_t counts = 0;
  size_t entries() const { return counts & 0x3ffu; }
  /// All its sums are.
  bool is_zero() const { return packed_width == 0 && counts == 0; }
  bool is_split() const;
  int width() const;
};
inline constexpr uint8_t split_line = 0x80;
inline bool LineHeader::is_split() const { return (packed_width & split_line) != 0; }
inline int LineHeader::width() const { return packed_width & ~split_line; }
inline constexpr size_t line_header_bytes = sizeof(LineHeader);
inline constexpr uint16_t uniform_line = 0xffff;
inline constexpr size_t most_counted = 63;

/// What follows a header, which may be that of a line that is the same all over: its sum alone.
inline size_t word_bytes(const LineHeader& header, const uint8_t* content) {
  if (header.is_split()) return load<WordSplit>(content).bytes;
  return words_per_line / 8 * size_t(header.width());
}
inline size_t content_bytes(const LineHeader& header, const uint8_t* content) {
  if (header.counts == uniform_line) return sizeof(Fixed);
  return word_bytes(header, content) + header.entries() * entry_bytes;
}

/// The same where nobody knows what the bytes are, of which there are `most`: nothing unless header
/// and content are such as SumLine::pack() writes.
std::optional<size_t> checked_content_bytes(const LineHeader& header, const uint8_t* content,
                                            size_t most);

/// Calls take(place, sum) for all that is set aside.
template <typename Take>
inline void for_set_aside(const uint8_t* entries, size_t count, const Take& take) {
  for (const uint8_t *at = entries, *end = at + count * entry_bytes; at < end; at += entry_bytes) {
    const auto place = load<uint16_t>(at);
    WideSum sum{load<uint64_t>(at + 2), load<int64_t>(at + 10)};
    if (place & has_more) {
      at += entry_bytes;
      sum.whole = Fixed(UnsignedFixed(load<uint64_t>(at + 10)) << 64 | uint64_t(sum.whole));
    }
    take(size_t(place & ~has_more), sum);
  }
}

/// Returns its end.
uint8_t* write_set_aside(size_t place, const WideSum& sum, uint8_t* at);

/// Sums of so many pixels from the first on, `stride` apart, cut at ±fixed_limit.
void read_line(const LineHeader& header, const uint8_t* content, size_t first, size_t count,
               Fixed* sums, size_t stride);

}  // namespace kaustik
