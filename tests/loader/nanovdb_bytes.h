#pragma once
// A small file of NanoVDB.

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace kaustik::nano {

/// Writes numbers into bytes at any place.
class NanoBytes {
 public:
  template <typename T>
  void put(size_t at, const T& value) {
    if (bytes.size() < at + sizeof(T)) bytes.resize(at + sizeof(T));
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
  void set_bit(size_t at, size_t bit) { bytes[at + bit / 8] |= uint8_t(1 << (bit % 8)); }
  std::vector<uint8_t> bytes;
};

inline constexpr size_t tree_at = 672, root_at = tree_at + 64, upper_at = root_at + 64 + 32,
                        lower_at = upper_at + 270400, leaf_at = lower_at + 33856,
                        end_at = leaf_at + 2144;

/// A voxel of 0.5 m, moved by (1, 2, 3) m. The leaf of voxels (0, 0, 0) to (7, 7, 7) holds
/// x + 10 y + 100 z; the next one along z is a tile of 5.
inline NanoBytes small_grid() {
  NanoBytes grid;
  grid.bytes.resize(end_at);
  std::memcpy(grid.bytes.data(), "NanoVDB0", 8);
  grid.put(32, uint64_t(end_at));
  for (size_t i = 0; i < 3; ++i) {
    grid.put(296 + 88 + 8 * (4 * i), 0.5);
    grid.put(296 + 232 + 8 * i, double(i + 1));
  }
  grid.put(636, uint32_t(1));
  grid.put(tree_at + 24, uint64_t(root_at - tree_at));
  const int32_t low[] = {0, 0, 0}, high[] = {7, 7, 15};
  for (size_t i = 0; i < 3; ++i) {
    grid.put(root_at + 4 * i, low[i]);
    grid.put(root_at + 12 + 4 * i, high[i]);
  }
  grid.put(root_at + 24, uint32_t(1));
  grid.put(root_at + 64 + 8, uint64_t(upper_at - root_at));
  grid.set_bit(upper_at + 4128, 0);
  grid.put(upper_at + 8256, uint64_t(lower_at - upper_at));
  grid.set_bit(lower_at + 544, 0);
  grid.put(lower_at + 1088, uint64_t(leaf_at - lower_at));
  grid.put(lower_at + 1088 + 8, 5.0f);
  for (size_t i = 0; i < 512; ++i)
    grid.put(leaf_at + 96 + 4 * i, float(i >> 6) + 10 * float((i >> 3) & 7) + 100 * float(i & 7));
  return grid;
}

enum class Codec : uint16_t { none, zip, blosc };

inline std::vector<uint8_t> file_of(const NanoBytes& grid, Codec codec = Codec::none,
                                    const std::string& name = "density") {
  std::vector<uint8_t> stored = grid.bytes;
  if (codec == Codec::zip) {
    uLongf size = compressBound(uLong(grid.bytes.size()));
    stored.resize(8 + size);
    compress(stored.data() + 8, &size, grid.bytes.data(), uLong(grid.bytes.size()));
    stored.resize(8 + size);
    const auto packed = uint64_t(size);
    std::memcpy(stored.data(), &packed, 8);
  }
  NanoBytes file;
  file.bytes.resize(16 + 176);
  std::memcpy(file.bytes.data(), "NanoVDB0", 8);
  file.put(8, uint32_t(32u << 21));
  file.put(12, uint16_t(1));
  file.put(14, codec);
  file.put(16, uint64_t(grid.bytes.size()));
  file.put(16 + 8, uint64_t(stored.size()));
  file.put(16 + 136, uint32_t(name.size() + 1));
  file.put(16 + 168, codec);
  file.bytes.insert(file.bytes.end(), name.begin(), name.end());
  file.bytes.push_back(0);
  file.bytes.insert(file.bytes.end(), stored.begin(), stored.end());
  return file.bytes;
}

}  // namespace kaustik::nano
