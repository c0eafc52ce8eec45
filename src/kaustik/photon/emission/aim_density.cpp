// Densities of aimed rays: sums over all the spheres that a ray meets. Compiled once per
// instruction set, of which Highway chooses at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kaustik/photon/emission/aim_density.cpp"
#include <hwy/foreach_target.h>
// Highway asks for this order.
#include <hwy/highway.h>

#include "kaustik/photon/emission/aim_density.h"

#ifndef KAUSTIK_AIM_DENSITY_CONSTANTS
#define KAUSTIK_AIM_DENSITY_CONSTANTS
namespace kaustik {
/// What rounding of a direction may shift it by, squared and with room to spare: added to the
/// squared sine of every cone's half angle.
inline constexpr float rounding_sine_sq = 6e-10f;
}  // namespace kaustik
#endif

HWY_BEFORE_NAMESPACE();
namespace kaustik::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, AimTable::padding>;
using Vector = hn::Vec<Tag>;

struct Vector3 {
  Vector x, y, z;
};

HWY_INLINE Vector dot3(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vector cross_length_sq(const Vector3& a, const Vector3& b) {
  const Vector3 c{hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
                  hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
  return dot3(c, c);
}

HWY_INLINE Vector3 set3(Tag d, const Vec3f& v) {
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

/// From `from` to the centres of the spheres from index `i` on.
HWY_INLINE Vector3 to_centers(Tag d, const AimTable& t, size_t i, const Vector3& from) {
  return {hn::Sub(hn::LoadU(d, t.x.data() + i), from.x),
          hn::Sub(hn::LoadU(d, t.y.data() + i), from.y),
          hn::Sub(hn::LoadU(d, t.z.data() + i), from.z)};
}

template <bool of_ball>
HWY_INLINE AimSums sum_of_cones(const AimTable& t, const Vec3f& origin, const Vec3f& direction,
                                float own_limit, const Vec3f& ball_center, const Vec3f& normal) {
  const Tag d;
  const Vector3 from = set3(d, origin), along = set3(d, direction);
  const Vector3 ball = set3(d, ball_center), facing = set3(d, normal);
  const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  Vector cones = zero, own = zero, position = zero;
  for (size_t i = 0; i < t.x.size(); i += hn::Lanes(d)) {
    const Vector3 to = to_centers(d, t, i, from);
    const Vector distance_sq = dot3(to, to);
    const Vector radius_sq =
        hn::MulAdd(hn::Set(d, rounding_sine_sq), distance_sq, hn::LoadU(d, t.radius_sq.data() + i));
    Vector weight = hn::LoadU(d, t.weight.data() + i);
    if constexpr (of_ball) {
      const auto in_cap =
          hn::Ge(dot3(to_centers(d, t, i, ball), facing), hn::LoadU(d, t.cap_threshold.data() + i));
      weight = hn::IfThenElseZero(in_cap, weight);
      position = hn::Add(position, weight);
    }
    const auto is_own = hn::Le(hn::Mul(distance_sq, hn::Set(d, own_limit)), radius_sq);
    const auto ahead = hn::Gt(dot3(to, along), zero);
    const auto met = hn::And(hn::Le(cross_length_sq(along, to), radius_sq), ahead);
    if (hn::AllFalse(d, hn::Or(is_own, met))) continue;
    own = hn::Add(own, hn::IfThenElseZero(is_own, weight));
    const Vector sine_sq = hn::Min(hn::Div(radius_sq, distance_sq), one);
    const Vector cosine = hn::Sqrt(hn::Sub(one, sine_sq));
    const Vector density = hn::Div(hn::Mul(weight, hn::Add(one, cosine)), sine_sq);
    cones = hn::Add(cones, hn::IfThenElseZero(hn::AndNot(is_own, met), density));
  }
  AimSums sums;
  sums.cones = hn::GetLane(hn::SumOfLanes(d, cones)) * (0.5f * inv_pi);
  sums.own = hn::GetLane(hn::SumOfLanes(d, own));
  sums.position = hn::GetLane(hn::SumOfLanes(d, position));
  return sums;
}

AimSums SumCones(const AimTable& table, const Vec3f& origin, const Vec3f& direction,
                 float own_limit) {
  return sum_of_cones<false>(table, origin, direction, own_limit, origin, direction);
}

AimSums SumConesOfBall(const AimTable& table, const Vec3f& origin, const Vec3f& direction,
                       float own_limit, const Vec3f& ball_center, const Vec3f& normal) {
  return sum_of_cones<true>(table, origin, direction, own_limit, ball_center, normal);
}

float SumDisks(const AimTable& t, const Vec3f& origin, const Vec3f& direction) {
  const Tag d;
  const Vector3 from = set3(d, origin), along = set3(d, direction);
  Vector sum = hn::Zero(d);
  for (size_t i = 0; i < t.x.size(); i += hn::Lanes(d)) {
    const Vector3 to = to_centers(d, t, i, from);
    const auto met = hn::Le(cross_length_sq(along, to), hn::LoadU(d, t.radius_sq.data() + i));
    sum = hn::Add(sum, hn::IfThenElseZero(met, hn::LoadU(d, t.weight.data() + i)));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace
}  // namespace kaustik::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kaustik {
namespace {
HWY_EXPORT(SumCones);
HWY_EXPORT(SumConesOfBall);
HWY_EXPORT(SumDisks);
}  // namespace

void AimTable::add(const Vec3f& center, float radius, float sphere_weight, float threshold) {
  x.push_back(center.x);
  y.push_back(center.y);
  z.push_back(center.z);
  radius_sq.push_back(sqr(radius));
  weight.push_back(sphere_weight);
  cap_threshold.push_back(threshold);
}

void AimTable::pad() {
  while (x.size() % padding != 0) {
    add({0, 0, 0}, 0, 0, infinity);
    // Negative enough that rounding_sine_sq × distance² never makes up for it.
    radius_sq.back() = -infinity;
  }
}

AimCone cone_toward(const Vec3f& center, float radius_sq, const Vec3f& origin, float own_limit) {
  const Vec3f to = center - origin;
  const float distance_sq = length_sq(to);
  const float widened_sq = radius_sq + rounding_sine_sq * distance_sq;
  AimCone cone;
  cone.own = distance_sq * own_limit <= widened_sq;
  if (cone.own) return cone;
  const float sine_sq = std::min(widened_sq / distance_sq, 1.0f);
  cone.axis = to * (1.0f / std::sqrt(distance_sq));
  cone.one_minus_cos = sine_sq / (1.0f + std::sqrt(1.0f - sine_sq));
  return cone;
}

AimSums sum_cones(const AimTable& table, const Vec3f& origin, const Vec3f& direction,
                  float own_limit) {
  return HWY_DYNAMIC_DISPATCH(SumCones)(table, origin, direction, own_limit);
}

AimSums sum_cones_of_ball(const AimTable& table, const Vec3f& origin, const Vec3f& direction,
                          float own_limit, const Vec3f& ball_center, const Vec3f& normal) {
  return HWY_DYNAMIC_DISPATCH(SumConesOfBall)(table, origin, direction, own_limit, ball_center,
                                              normal);
}

float sum_disks(const AimTable& table, const Vec3f& origin, const Vec3f& direction) {
  return HWY_DYNAMIC_DISPATCH(SumDisks)(table, origin, direction);
}

}  // namespace kaustik
#endif
