#pragma once
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Points of the unit square, by a grid of cells that differ in density.
class SquareDistribution {
 public:
  /// `weights` row by row, finite and at least 0: how much lies in each cell, in any unit. A share
  /// of the points is uniform, so that what the weights miss has a density, too; all of them are
  /// where there is no weight. Width and height are above 0.
  SquareDistribution(int width, int height, const std::vector<double>& weights,
                     double uniform_share);

  Vec2f sample(const Vec2f& u) const {
    float density;
    return sample(u, density);
  }
  /// With the density that it was drawn with: at an edge of its cell pdf() may be a neighbour's.
  Vec2f sample(const Vec2f& u, float& density) const;
  /// 0 outside of the square.
  float pdf(const Vec2f& p) const;

 private:
  int width_, height_;
  std::vector<float> density_;
  std::vector<double> row_ends_;   ///< shares of the rows, summed up; the last is 1
  std::vector<double> cell_ends_;  ///< the same of the cells of each row
};

}  // namespace kaustik
