#pragma once
#include <algorithm>
#include <cstring>
#include <vector>

#include "kaustik/image/image.h"

namespace kaustik::test {

/// Whether two pictures have the same channels, with the same bits.
inline bool same_bits(const Image& a, const Image& b) {
  if (a.channel_names() != b.channel_names() || a.width() != b.width() || a.height() != b.height())
    return false;
  for (int c = 0; c < a.channel_count(); ++c)
    if (std::memcmp(a.channel(c).data(), b.channel(c).data(), a.channel(c).size_bytes()) != 0)
      return false;
  return true;
}
inline bool same_bits(const std::vector<Image>& a, const std::vector<Image>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Image& x, const Image& y) { return same_bits(x, y); });
}

}  // namespace kaustik::test
