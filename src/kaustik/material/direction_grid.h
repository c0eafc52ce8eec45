#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Cells over the sphere of directions, none of which reaches over the horizon: for tests that
/// compare how often directions are drawn with their density.
class DirectionGrid {
 public:
  /// Narrow about the mirror direction of wo, where lobes are.
  explicit DirectionGrid(const Vec3f& wo);
  /// So many rows (at least 1) of equal height along z, with twice as many cells each.
  static DirectionGrid even(int rows);

  size_t size() const { return (thetas_.size() - 1) * (phis_.size() - 1); }
  size_t cell_of(const Vec3f& w) const;
  /// Integral of f(direction) per solid angle over a cell, adaptive, good to about 1e-5.
  Vec3d integrate(size_t cell, const std::function<Vec3d(const Vec3f&)>& f) const;

 private:
  DirectionGrid() = default;

  std::vector<double> thetas_, phis_;  ///< borders; phi relative to `first_phi_`
  double first_phi_ = 0;
};

}  // namespace kaustik
