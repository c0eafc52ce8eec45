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
/// matter. A tree of boxes with the least R in each finds the j that counts.
class NeighborClamping {
 public:
  struct Site {
    Vec3f position, normal;
    float distance;  ///< R_j ≥ 0, m, may be infinite
  };

  explicit NeighborClamping(std::vector<Site> sites);

  /// `distance` clamped by all sites but for those that face apart from `normal`, as across a thin
  /// wall.
  float clamped(const Vec3f& position, const Vec3f& normal, float distance) const;

 private:
  struct Node {
    Bounds3f bounds;
    float least = infinity;       ///< of the distances in it
    uint32_t begin = 0, end = 0;  ///< sites of a leaf
    uint32_t second = 0;          ///< the other child; the first follows its parent. 0: a leaf
  };

  void build(uint32_t begin, uint32_t end);

  std::vector<Site> sites_;
  std::vector<Node> nodes_;
};

}  // namespace kaustik
