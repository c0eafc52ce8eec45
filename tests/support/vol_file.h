#pragma once
// Files of Mitsuba's format VOL.

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace kaustik::test {

struct VolOptions {
  int32_t channels = 1;
  int32_t encoding = 1;  ///< 1: floats, 3: bytes that stand for 0 to 1
  std::array<float, 6> box = {0, 0, 0, 1, 1, 1};
};

/// The bytes of a file of so many cells; x runs fastest.
inline std::string vol_file(const std::array<int32_t, 3>& size, const std::vector<float>& values,
                            const VolOptions& options = {}) {
  std::string bytes = "VOL\x03";
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  put(options.encoding);
  for (const int32_t count : size) put(count);
  put(options.channels);
  for (const float bound : options.box) put(bound);
  for (const float value : values)
    if (options.encoding == 3)
      put(uint8_t(value * 255));
    else
      put(value);
  return bytes;
}

}  // namespace kaustik::test
