#pragma once
// What several shapes share; not for other rooms.

#include <bit>
#include <optional>

#include "kaustik/base/limits.h"
#include "kaustik/base/sampler.h"
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// A sample by solid angle, with the density per area that it stands for.
ShapeSample sample_of(const SurfacePoint& point, const Vec3f& reference, float pdf_solid_angle);

/// The box from `low` to `high`, grown by a few roundings of its coordinates.
Bounds3f rounded_outward(const Vec3d& low, const Vec3d& high);
/// The part that two boxes share; for boxes that are known to overlap.
Bounds3f common_part(const Bounds3f& a, const Bounds3f& b);

/// How far rounding each coordinate of `position` to float can have moved it along the normal; the
/// error of a point that was computed in double precision.
float position_rounding(const Vec3f& position, const Vec3f& unit_normal);

Vec3d transform_point(const Transform& t, const Vec3d& p);
Vec3d transform_vector(const Transform& t, const Vec3d& v);
/// Some unit vector at right angles to `unit`.
Vec3d orthogonal_to(const Vec3d& unit);

/// The parameter `to_world`. Throws Error(input) if it is a projection.
const Transform& affine_to_world(const Arguments& arguments);
/// The factor by which a transform scales all lengths; none if it shears or scales unevenly.
std::optional<double> similarity_scale(const Transform& transform);

/// Numbers beside the two that a sample is given, for what draws again after a number that it
/// refuses: always the same for the same two.
class FurtherNumbers {
 public:
  explicit FurtherNumbers(const Vec2f& u)
      : seed_((uint64_t(std::bit_cast<uint32_t>(u.x)) << 32) | std::bit_cast<uint32_t>(u.y)) {}
  /// In [0, 1).
  float next() { return float(hash_mix(seed_, count_++) >> 40) * 0x1p-24f; }
  Vec2f next_2d() {
    const float x = next();
    return {x, next()};
  }

 private:
  uint64_t seed_, count_ = 0;
};
/// After so many refusals what comes next is taken: each is as likely as not, or less likely.
inline constexpr int most_draws = 60;

}  // namespace kaustik
