#include "kaustik/render/packed_line.h"

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
