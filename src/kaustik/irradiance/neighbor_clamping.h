#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Křivánek, Bouatouch, Pattanaik and Žára 2006, "Making radiance and irradiance caching
/// practical": R_i ≤ R_j + |p_i − p_j|, so that a record whose rays missed something small learns
/// of it from its neighbours. The right side takes the R_j as they were measured: by the triangle
/// inequality chains of neighbours couldn't lower R_i further, so the order of the records doesn't
/// matter.
class NeighborClamping {
 public:
  /// `distance` R_j ≥ 0 in m, may be infinite.
  void add(const Vec3f& position, const Vec3f& normal, float distance);

  /// `distance` clamped by all added records from number `first` on, but for those that face apart
  /// from `normal`, as across a thin wall. (A few before `first` may take part as well.)
  float clamped(const Vec3f& position, const Vec3f& normal, float distance, size_t first) const;

  size_t size_in_bytes() const { return blocks_.capacity() * sizeof(Block); }

 private:
  using Lanes = float __attribute__((vector_size(16)));
  using Mask = int32_t __attribute__((vector_size(16)));
  struct Block {
    Lanes position[3], normal[3], distance;
  };

  std::vector<Block> blocks_;
  size_t count_ = 0;
};

}  // namespace kaustik
