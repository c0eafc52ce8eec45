#pragma once
// A table for moving the chosen ones of eight lanes to the front.

#include <array>
#include <cstdint>

namespace kaustik {

/// For each set of 8 lanes (bit i: lane i) which lane goes where: four bits per place, the first
/// place lowest.
///
/// Highway's own table for AVX2 is a local variable that g++ copies at every use.
inline constexpr std::array<uint32_t, 256> kd_pack_table = [] {
  std::array<uint32_t, 256> table{};
  for (uint32_t set = 0; set < 256; ++set) {
    uint32_t shift = 0;
    for (uint32_t lane = 0; lane < 8; ++lane) {
      if ((set >> lane & 1) == 0) continue;
      table[set] |= lane << shift;
      shift += 4;
    }
  }
  return table;
}();

}  // namespace kaustik
