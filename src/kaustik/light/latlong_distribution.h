#pragma once
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// A place on the sphere: `turn` in [0, 1) around the axis, `height` the cosine of the angle from
/// it.
struct LatLong {
  double turn = 0, height = 1;
};

/// Directions by a grid of brightnesses: the density per solid angle is bilinear in turn and height
/// between the nodes. Column c stands at turn (c + 1/2)/width and goes round; row r at the angle
/// r/(rows − 1) · `last_angle` from the axis. Beyond the last row the density is zero. A function
/// that is bilinear between the same nodes is never positive where the density is zero.
class LatLongDistribution {
 public:
  /// `values`: row by row, finite and at least 0; at least 2 rows and 1 column. Angles in radians.
  LatLongDistribution(int width, std::vector<float> values, double last_angle);

  /// Integral of the values over solid angle; zero: nothing can be sampled.
  double integral() const { return integral_; }
  /// Not while the integral is zero.
  LatLong sample(const Vec2f& u) const;
  /// Per solid angle.
  float pdf(const LatLong& at) const;

 private:
  struct Corners {
    double v00, v10, v01, v11;  ///< by (column, row)
    double mean() const { return 0.25 * (v00 + v10 + v01 + v11); }
  };
  Corners corners(int row, int column) const;
  int row_of(double height) const;

  int width_, rows_;
  double last_angle_;
  std::vector<double> heights_;  ///< of the rows, descending
  std::vector<float> values_;
  std::vector<double> cumulative_;  ///< of the cells of each row, from zero: width + 1 per row
  std::vector<double> row_cumulative_;
  double integral_ = 0;
};

}  // namespace kaustik
