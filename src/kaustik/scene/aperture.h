#pragma once
// What cameras with a lens share; not for other rooms.

#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// The opening of a lens: a disk, or a regular polygon whose corners lie on its edge.
class Aperture {
 public:
  /// Of the rows aperture_radius, blades and blade_rotation. Throws Error(input) for a polygon of
  /// fewer than three corners.
  explicit Aperture(const Arguments& arguments);

  float radius() const { return radius_; }
  /// Evenly over the opening, m from its middle; {0.5, 0.5} of a disk is the middle.
  Vec2f at(const Vec2f& u) const;

 private:
  float radius_;           ///< m
  int blades_;             ///< 0: a disk
  float blade_angle_ = 0;  ///< of the polygon's first corner, radians
};

/// The rows of a camera with a lens: `aperture_radius` by its default and sentence, focus_distance,
/// blades and blade_rotation.
std::vector<Parameter> lens_parameters(Parameter aperture_radius);

}  // namespace kaustik
