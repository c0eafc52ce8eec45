#pragma once
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Bounding spheres that a light is aimed at, as arrays for vector instructions: padded to
/// `AimTable::padding` with spheres that no ray meets.
struct AimTable {
  static constexpr size_t padding = 16;

  std::vector<float> x, y, z;
  std::vector<float> radius_sq;
  /// Mixture weight: chance of the sphere, for balls over the area of its cap, for disks over the
  /// area of the disk.
  std::vector<float> weight;
  /// Balls only: a point of the ball in direction n of its centre belongs to the sphere's cap if
  /// n · (sphere's centre − ball's centre) is at least this.
  std::vector<float> cap_threshold;

  void add(const Vec3f& center, float radius, float sphere_weight, float threshold);
  void pad();
  Vec3f center(size_t i) const { return {x[i], y[i], z[i]}; }
};

/// The cone that a sphere subtends at a point, or the note that the light's own distribution stands
/// in for it because the point is inside (or the cone as wide as all that the light emits).
struct AimCone {
  Vec3f axis;
  float one_minus_cos = 0;
  bool own = false;
};
/// `own_limit`: the squared sine of half the cone's angle from which on the light's own
/// distribution stands in. Spheres are widened by what rounding of a direction may shift.
AimCone cone_toward(const Vec3f& center, float radius_sq, const Vec3f& origin, float own_limit);

/// Sums over the spheres of a table, for a ray.
struct AimSums {
  float cones = 0;     ///< weight / solid angle of the cones that hold the direction
  float own = 0;       ///< weights of those that the light's own distribution stands in for
  float position = 0;  ///< weights of all whose caps hold the origin (balls only)
};
AimSums sum_cones(const AimTable& table, const Vec3f& origin, const Vec3f& direction,
                  float own_limit);
/// For an origin on a ball, in direction `normal` from `ball_center`: only over spheres whose caps
/// hold the origin.
AimSums sum_cones_of_ball(const AimTable& table, const Vec3f& origin, const Vec3f& direction,
                          float own_limit, const Vec3f& ball_center, const Vec3f& normal);
/// Sum of the weights of the spheres that the whole line meets.
float sum_disks(const AimTable& table, const Vec3f& origin, const Vec3f& direction);

}  // namespace kaustik
