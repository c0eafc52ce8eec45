#include "kaustik/render/packed_line.h"

#include <bitset>
#include <cmath>

namespace kaustik {

void WideSum::add(Fixed value) {
  const UnsignedFixed low = UnsignedFixed(fraction) + uint64_t(value);
  fraction = uint64_t(low);
  whole += (value >> 64) + Fixed(low >> 64);
}

void WideSum::add(const WideSum& other) {
  const UnsignedFixed low = UnsignedFixed(fraction) + other.fraction;
  fraction = uint64_t(low);
  whole += other.whole + Fixed(low >> 64);
}

Fixed WideSum::cut() const {
  const Fixed limit = fixed_limit >> 64;
  if (whole >= limit) return fixed_limit;
  if (whole < -limit) return -fixed_limit;
  return Fixed(UnsignedFixed(whole) << 64 | fraction);
}

uint8_t* write_set_aside(size_t place, const WideSum& sum, uint8_t* at) {
  const bool more = sum.whole != int64_t(sum.whole);
  store(at, uint16_t(place | (more ? has_more : 0)));
  store(at + 2, sum.fraction);
  store(at + 10, uint64_t(sum.whole));
  if (!more) return at + entry_bytes;
  at += entry_bytes;
  store(at, uint16_t(place));
  store(at + 2, uint64_t(0));
  store(at + 10, uint64_t(sum.whole >> 64));
  return at + entry_bytes;
}

namespace {

/// One each of sums that a Fixed holds.
bool are_valid_entries(const uint8_t* at, size_t count) {
  std::bitset<words_per_line> there;
  for (; count > 0; --count, at += entry_bytes) {
    const size_t place = load<uint16_t>(at);
    if (place >= words_per_line || there[place]) return false;
    if (std::abs(double(load<int64_t>(at + 10))) > fixed_maximum) return false;
    there[place] = true;
  }
  return true;
}

}  // namespace

std::optional<size_t> checked_content_bytes(const LineHeader& header, const uint8_t* content,
                                            size_t most) {
  if (header.counts == uniform_line) {
    const bool is_valid = header.packed_width == 0 && most >= sizeof(Fixed) &&
                          width_of(load<Fixed>(content)) <= top_of_words;
    return is_valid ? std::optional(sizeof(Fixed)) : std::nullopt;
  }
  const int width = header.width();
  if (width > most_wide || header.shift + width > top_of_words) return std::nullopt;
  const std::optional<size_t> words = header.is_split() ? checked_split_bytes(width, content, most)
                                                        : words_per_line / 8 * size_t(width);
  if (!words) return std::nullopt;
  const size_t bytes = *words + header.entries() * entry_bytes;
  if (bytes > most || !are_valid_entries(content + *words, header.entries())) return std::nullopt;
  return bytes;
}

void read_line(const LineHeader& header, const uint8_t* content, size_t first, size_t count,
               Fixed* sums, size_t stride) {
  const bool is_uniform = header.counts == uniform_line;
  const int width = header.width();
  if (header.is_split()) {
    SplitReader words(content, width, first);
    for (size_t i = 0; i < count; ++i) sums[i * stride] = words.next() << header.shift;
  } else {
    for (size_t i = 0; i < count; ++i) {
      Fixed& sum = sums[i * stride];
      if (is_uniform)
        sum = load<Fixed>(content);
      else if (width == 0)
        sum = 0;
      else if (width > most_narrow)
        sum = word_at<Fixed>(content, width, first + i) << header.shift;
      else
        sum = Fixed(word_at<int64_t>(content, width, first + i)) << header.shift;
    }
  }
  if (is_uniform) return;
  content += word_bytes(header, content);
  for_set_aside(content, header.entries(), [&](size_t place, WideSum sum) {
    if (place < first || place >= first + count) return;
    Fixed& of_pixel = sums[(place - first) * stride];
    sum.add(of_pixel);
    of_pixel = sum.cut();
  });
}

}  // namespace kaustik
