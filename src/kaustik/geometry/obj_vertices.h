#pragma once
// Which corners of an OBJ file's faces become one vertex; for its reader alone.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kaustik/base/memory.h"
#include "kaustik/base/sampler.h"

namespace kaustik {

/// Which position, texture coordinate and normal one corner of a face uses.
struct ObjCorner {
  static constexpr uint32_t none = 0xffffffffu;
  uint32_t position = none, uv = none, normal = none;
  friend bool operator==(const ObjCorner&, const ObjCorner&) = default;
};

/// Numbers of different corners, found by what the corners use (a hash table, probed linearly).
class ObjCornerTable {
 public:
  /// The number under which `corner` is known; if it is new, `next`, under which it is from now on.
  /// `corner_of(number)` tells what is known.
  template <typename CornerOf>
  uint32_t number_of(const ObjCorner& corner, uint32_t next, const CornerOf& corner_of) {
    if (4 * (used_ + 1) > 3 * slots_.size()) grow(corner_of);
    uint32_t& slot = slots_[place_of(corner, corner_of)];
    if (slot == ObjCorner::none) {
      slot = next;
      ++used_;
    }
    return slot;
  }
  /// Forgets all.
  void clear() {
    std::fill(slots_.begin(), slots_.end(), ObjCorner::none);
    used_ = 0;
  }

 private:
  static uint64_t hash_of(const ObjCorner& corner) {
    return hash_mix((uint64_t(corner.position) << 32) | corner.uv, corner.normal);
  }

  template <typename CornerOf>
  size_t place_of(const ObjCorner& corner, const CornerOf& corner_of) const {
    const size_t mask = slots_.size() - 1;
    size_t place = size_t(hash_of(corner)) & mask;
    while (slots_[place] != ObjCorner::none && !(corner_of(slots_[place]) == corner))
      place = (place + 1) & mask;
    return place;
  }
  template <typename CornerOf>
  void grow(const CornerOf& corner_of) {
    std::vector<uint32_t> before(slots_.empty() ? 1024 : 2 * slots_.size(), ObjCorner::none);
    before.swap(slots_);
    for (const uint32_t number : before)
      if (number != ObjCorner::none) slots_[place_of(corner_of(number), corner_of)] = number;
  }

  std::vector<uint32_t> slots_;  ///< a power of two of them
  size_t used_ = 0;
};

/// The vertices of a mesh, in the order in which corners first ask for them. In memory they are
/// what corners use; their numbers are looked up by position, and in a table only where corners
/// share a position and nothing else.
class ObjVertices {
 public:
  /// Of corners that use so many positions.
  explicit ObjVertices(size_t positions) : first_(positions, ObjCorner::none) {}

  /// Room for so many.
  void reserve(size_t vertices);
  uint32_t vertex_of(const ObjCorner& corner);
  size_t size() const { return positions_.size(); }
  /// What only looks up numbers is not needed any more.
  void finish();

  /// What each vertex uses; whose vectors may be taken away once finished.
  UnsetVector<uint32_t>& positions() { return positions_; }
  UnsetVector<uint32_t>& uvs() { return uvs_; }
  UnsetVector<uint32_t>& normals() { return normals_; }

 private:
  ObjCorner corner_of(uint32_t vertex) const {
    return {positions_[vertex], uvs_[vertex], normals_[vertex]};
  }

  UnsetVector<uint32_t> first_;  ///< vertex of each position
  ObjCornerTable others_;        ///< of positions that have more than one vertex
  UnsetVector<uint32_t> positions_, uvs_, normals_;
};

}  // namespace kaustik
