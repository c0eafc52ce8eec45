#pragma once
#include <array>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Affine (or projective) map in the column-vector convention of Mitsuba: p' = M p. Held in double
/// precision with its inverse; names read `target_from_source`. One that collapses space has none.
class Transform {
 public:
  Transform() = default;
  /// `rows[i][j]`: row i, column j of M. Throws std::invalid_argument when M is singular or not
  /// finite.
  explicit Transform(const double (&rows)[4][4]);
  /// Of its matrix and its inverse, as another has them to the bit: of a copy elsewhere. Throws
  /// std::invalid_argument when one is not finite, or they are not inverse of one another.
  Transform(const double (&rows)[4][4], const double (&inverse)[4][4]);

  /// Affine, and may be singular: one that leaves less than three of the space's dimensions. Where
  /// it leaves two, everything lands in a plane, and normal() gives those of the plane for all that
  /// do not lie along it. Throws std::invalid_argument when M is not finite or no affine map.
  static Transform collapsing(const double (&rows)[4][4]);

  static Transform translate(const Vec3d& offset);
  /// No factor may be zero (throws as the constructor does).
  static Transform scale(const Vec3d& factors);
  /// Right-handed rotation about `axis` (any length but zero) by degrees.
  static Transform rotate(const Vec3d& axis, double degrees);
  /// Camera to world: the camera at `origin` looks along its own +z toward `target`; +x points to
  /// the left of the image, as in Mitsuba. Throws std::invalid_argument when the vectors are
  /// degenerate.
  static Transform look_at(const Vec3d& origin, const Vec3d& target, const Vec3d& up);

  /// First `b`, then `a`.
  friend Transform operator*(const Transform& a, const Transform& b);
  friend bool operator==(const Transform&, const Transform&) = default;

  Vec3f point(const Vec3f& p) const;
  Vec3f vector(const Vec3f& v) const;
  /// By the inverse transpose; not normalised.
  Vec3f normal(const Vec3f& n) const;
  /// Of one that leaves all dimensions.
  Transform inverse() const;
  Bounds3f bounds(const Bounds3f& b) const;
  /// Negative where the map turns right-handed frames into left-handed ones; zero where it
  /// collapses space.
  double determinant3() const;
  /// Of the space, as many as are left: 3 unless the map collapses it.
  int dimensions() const { return dimensions_; }
  double at(int row, int column) const { return matrix_[row][column]; }

 private:
  using Rows = std::array<std::array<double, 4>, 4>;
  /// Of a map that leaves at most so many dimensions.
  static Transform collapsed(const Rows& rows, int most_dimensions);
  static constexpr Rows identity_rows = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  Rows matrix_ = identity_rows;
  Rows inverse_ = identity_rows;  ///< of one that collapses space only what normal() needs
  int dimensions_ = 3;
};

}  // namespace kaustik
