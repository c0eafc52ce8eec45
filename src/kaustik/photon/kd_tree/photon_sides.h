#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/base/kept_array.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// The sides on which photons arrived, in the order of a photon map, packed so that sixteen are
/// told apart at once: the one answer to "does this photon count here".
class PhotonSides {
 public:
  static constexpr uint32_t block_size = 16;
  struct Block {
    int8_t x[block_size], y[block_size], z[block_size];
    uint16_t front = 0;
  };
  static constexpr size_t block_count(size_t photons) {
    return (photons + block_size - 1) / block_size;
  }

  PhotonSides() = default;
  /// Blocks that another had, whose last one need not be full: nothing can be added.
  explicit PhotonSides(KeptArray<Block> blocks) : blocks_(std::move(blocks)) {}

  void reserve(size_t count) { blocks_.own().reserve(block_count(count)); }
  /// The next photon's unit normal on the side of arrival, in parts of 127, and whether that is the
  /// side of the surface's own normal.
  void add(int8_t x, int8_t y, int8_t z, bool on_front);
  /// Of memory of its own.
  size_t size_in_bytes() const { return blocks_.own_bytes(); }
  std::span<const Block> blocks() const { return blocks_.all(); }

  /// What a query accepts: photons whose side lies in the half space of a geometric normal, or
  /// (`both_sides`, where light passes through) photons whose surface's own normal does.
  struct Query {
    int16_t x, y, z;
    bool both_sides;
  };
  static Query query(const Vec3f& normal, bool both_sides);
  /// Bit i of the result: bit i of `mask` is set and photon `first` + i counts; `first` + i must
  /// stay within one run of sixteen.
  uint32_t accept(const Query& query, uint32_t first, uint32_t mask) const;
  /// The same for a single photon.
  bool accepts(const Query& query, uint32_t index) const {
    const Block& block = blocks_[index / block_size];
    const uint32_t lane = index % block_size;
    const int dot = block.x[lane] * query.x + block.y[lane] * query.y + block.z[lane] * query.z;
    if (!query.both_sides) return dot > 0;
    return (block.front >> lane & 1) != 0 ? dot > 0 : dot < 0;
  }

 private:
  KeptArray<Block> blocks_;
  uint32_t count_ = 0;
};

}  // namespace kaustik
