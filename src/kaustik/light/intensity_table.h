#pragma once
#include <numbers>
#include <utility>
#include <vector>

#include "kaustik/light/latlong_distribution.h"

namespace kaustik {

/// Luminous or radiant intensity about an axis: linear in turn and in angle between the nodes,
/// whatever their distances; round the axis it goes on from the last column to the first one. Zero
/// before the first angle and beyond the last one.
class IntensityTable {
 public:
  /// `turns` in [0, 1) and `angles` in [0, π], radians from the axis, both ascending: at least one
  /// column and two rows. `values`: row by row, finite and at least 0.
  IntensityTable(std::vector<double> turns, std::vector<double> angles, std::vector<float> values);

  /// The same with other values.
  IntensityTable times(float factor) const;

  float value(const LatLong& at) const;
  /// Over all directions: the flux.
  double integral() const;
  float maximum() const;
  /// Where it is: the first node that has it.
  LatLong brightest() const;
  /// Between the angles of which all light leaves, radians; 0 and 0 where there is none.
  std::pair<double, double> lit_angles() const;

  const std::vector<double>& turns() const { return turns_; }
  const std::vector<double>& angles() const { return angles_; }

 private:
  float node(size_t row, size_t column) const { return values_[row * turns_.size() + column]; }

  std::vector<double> turns_, angles_;
  std::vector<float> values_;
};

/// Draws directions about in proportion to a table; nowhere does it shine with a density of zero.
class IntensitySampler {
 public:
  /// It is linear in the cosine, the table in the angle: in such steps, radians, they are alike.
  /// Before the table's first angle it has one step of directions in which there is no light.
  static constexpr double widest_step = 2.5 * std::numbers::pi / 180;

  explicit IntensitySampler(const IntensityTable& table);

  LatLong sample(const Vec2f& u) const { return turned(distribution_.sample(u), first_turn_); }
  /// Per solid angle.
  float pdf(const LatLong& at) const { return distribution_.pdf(turned(at, -first_turn_)); }

 private:
  struct Grid;
  explicit IntensitySampler(const Grid& grid);
  static LatLong turned(LatLong at, double by) {
    at.turn += by;
    at.turn -= std::floor(at.turn);
    if (at.turn >= 1) at.turn = 0;
    return at;
  }

  double first_turn_;  ///< of the table where the distribution has 0
  LatLongDistribution distribution_;
};

}  // namespace kaustik
