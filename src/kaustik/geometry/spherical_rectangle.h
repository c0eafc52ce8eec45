#pragma once
#include <optional>

#include "kaustik/base/vec.h"

namespace kaustik {

/// A rectangle, or what it bounds, as seen from points near it: sampled by the solid angle that it
/// subtends, so that no sample counts for more than another, however near the point is (Ureña,
/// Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles", CGF 32(4),
/// 2013). Double precision inside.
class SphericalRectangle {
 public:
  /// The rectangle middle + x s + y t with x and y in [−1, 1]; none if s and t are not at right
  /// angles or zero.
  static std::optional<SphericalRectangle> make(const Vec3d& middle, const Vec3d& s,
                                                const Vec3d& t);

  /// As seen from one point.
  class View {
   public:
    /// Density per solid angle, everywhere on the rectangle.
    float pdf() const { return float(1 / solid_angle_); }
    /// The place x, y in [−1, 1]² of a uniform direction.
    Vec2f sample(const Vec2f& u) const;

   private:
    friend class SphericalRectangle;
    double x0_, x1_, y0_, y1_, z0_;  ///< of the rectangle, from the point; z0 < 0
    double b0_, b1_, k_, solid_angle_;
  };
  /// Distance over half the diagonal from which on samples by area do as well: their densities then
  /// differ by less than a factor of 2.
  static constexpr double far_ratio = 3;
  /// Nothing where the rectangle is farther than `ratio` times half its diagonal, to be sampled by
  /// its area, which is faster, or is seen edge-on.
  std::optional<View> seen_near(const Vec3f& reference, double ratio = far_ratio) const;

 private:
  Vec3d middle_, x_, y_, z_;  ///< unit axes
  double half_x_ = 0, half_y_ = 0;
};

}  // namespace kaustik
