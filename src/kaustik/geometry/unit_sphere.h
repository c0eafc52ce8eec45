#pragma once
// What spheres and ellipsoids share; not for other rooms.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kaustik/base/vec.h"
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// Where the ray `from` + t `direction`, relative to a sphere's centre, meets it first with t in
/// (0, t_max).
std::optional<double> sphere_hit(const Vec3d& from, const Vec3d& direction, double radius,
                                 double t_max);

/// The cone that a sphere fills, seen from a point outside of it.
class SphereCone {
 public:
  /// Nothing if the point lies inside, or on the sphere. `to_center`: from the point.
  static std::optional<SphereCone> make(const Vec3d& to_center, double radius);

  /// Density per solid angle of directions that are uniform in the cone.
  double pdf() const { return 1 / (2 * std::numbers::pi * one_minus_cos_); }
  /// The point that is seen in such a direction: a unit vector from the centre.
  Vec3d sample(const Vec2f& u) const;

 private:
  SphereCone() = default;

  Vec3d to_center_;
  double distance_sq_ = 0, sin_max_sq_ = 0;
  double one_minus_cos_ = 0;  ///< of the half angle
};

/// An icosahedron in the unit sphere, each triangle divided into four `level` times; seen from
/// outside corners run anticlockwise.
struct Icosphere {
  std::vector<Vec3d> units;
  TriangleList triangles;
};
Icosphere icosphere(int level);

/// A part of the unit sphere between four great circles, in what bounds it: it lies within the
/// convex hull of its corners and of those farther out by the factor `reach`.
struct SpherePatch {
  std::array<Vec3d, 4> corners;
  double reach;
};
/// The sphere cut into 6 `side`² patches of about the same size.
std::vector<SpherePatch> sphere_patches(int side);

/// A unit vector as two numbers in [−1, 1], and back: the octahedron that encloses it, unfolded
/// (Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010).
Vec2f square_from_unit(const Vec3d& unit);
Vec3d unit_from_square(const Vec2f& at);

}  // namespace kaustik
