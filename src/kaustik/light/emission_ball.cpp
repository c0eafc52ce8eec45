// What may come from balls, many at once; compiled once per instruction set, of which Highway
// chooses at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kaustik/light/emission_ball.cpp"
#include <hwy/foreach_target.h>
// Highway asks for this order.
#include <hwy/highway.h>

#include "kaustik/light/emission_ball.h"

HWY_BEFORE_NAMESPACE();
namespace kaustik::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// Rounding of directions must not hide a light at the border of its cone: near an axis the sine
/// that is found from the cosine is only so good.
HWY_INLINE float CosineSlack() { return 5e-4f; }

/// Conty Estevez and Kulla, eq. 4, for the sphere around the lights, whose angular radius is
/// θ_u: intensity · |cos max(0, θ_i − θ_u)| · cos max(0, θ − θ_o − θ_u) / d², where the cosines,
/// which are the best that any place in the sphere may have, are averaged with those of its centre:
/// only what is zero has to be taken at its best. `balls`: the numbers of EmissionBall in their
/// order, each `stride` behind the one before. Angles are kept as cosine and sine times the
/// distance, so that the roots don't wait for one another.
template <class D>
HWY_INLINE hn::Vec<D> irradiance_of(D d, const float* balls, size_t stride, const Vec3f& reference,
                                    const Vec3f& normal) {
  using Vector = hn::Vec<D>;
  const auto column = [&](size_t i) HWY_ATTR { return hn::LoadU(d, balls + i * stride); };
  const auto dot3 = [](Vector ax, Vector ay, Vector az, Vector bx, Vector by, Vector bz) HWY_ATTR {
    return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
  };
  const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const Vector x = hn::Sub(hn::Set(d, reference.x), column(0));
  const Vector y = hn::Sub(hn::Set(d, reference.y), column(1));
  const Vector z = hn::Sub(hn::Set(d, reference.z), column(2));
  const Vector radius = column(3);
  const Vector radius_sq = hn::Mul(radius, radius);
  const Vector distance_sq = dot3(x, y, z, x, y, z);
  const auto within = hn::Le(distance_sq, radius_sq);
  const Vector along = dot3(column(4), column(5), column(6), x, y, z);
  const Vector toward =
      hn::Neg(dot3(hn::Set(d, normal.x), hn::Set(d, normal.y), hn::Set(d, normal.z), x, y, z));

  const auto other_leg = [&](Vector leg_sq) HWY_ATTR {
    return hn::Sqrt(hn::Max(hn::Sub(distance_sq, leg_sq), zero));
  };
  const Vector distance = hn::Sqrt(distance_sq);
  const Vector tangent = other_leg(radius_sq);  // distance · cos θ_u; the radius is its sine
  const Vector across = other_leg(hn::Mul(along, along));
  const Vector beside = other_leg(hn::Mul(toward, toward));
  const Vector inverse_sq = hn::Div(one, hn::Max(distance_sq, hn::Set(d, 1e-30f)));
  // cos max(0, α − θ_u)
  const auto widened = [&](Vector cosine, Vector sine) HWY_ATTR {
    const Vector narrowed = hn::Mul(hn::MulAdd(cosine, tangent, hn::Mul(sine, radius)), inverse_sq);
    return hn::IfThenElse(hn::Or(within, hn::Gt(cosine, tangent)), one, narrowed);
  };
  const Vector half = hn::Set(d, 0.5f);
  const Vector half_inverse = hn::Mul(hn::Mul(half, distance), inverse_sq);
  const auto averaged = [&](Vector best, Vector at_center) HWY_ATTR {
    return hn::MulAdd(hn::Max(at_center, zero), half_inverse, hn::Mul(half, best));
  };

  // max(0, θ − θ_o)
  const Vector cos_spread = column(7), sin_spread = column(8);
  const Vector sin_beyond = hn::NegMulAdd(along, sin_spread, hn::Mul(across, cos_spread));
  const Vector cos_beyond =
      hn::IfThenElse(hn::Lt(sin_beyond, zero), distance,
                     hn::MulAdd(along, cos_spread, hn::Mul(across, sin_spread)));
  const Vector sin_outside = hn::Max(sin_beyond, zero);
  const Vector cos_emission = widened(cos_beyond, sin_outside);
  // sin max(0, θ − θ_o − θ_u)
  const Vector sin_emission = hn::Max(
      hn::Mul(hn::MulSub(sin_outside, tangent, hn::Mul(cos_beyond, radius)), inverse_sq), zero);
  const Vector ramp = column(10);
  const Vector emission = hn::IfThenElse(
      hn::Gt(ramp, zero), hn::NegMulAdd(ramp, averaged(sin_emission, sin_outside), one),
      averaged(cos_emission, cos_beyond));
  const bool any_side = normal.x == 0 && normal.y == 0 && normal.z == 0;
  const Vector cos_receiver = any_side ? one : widened(toward, beside);

  // Within the sphere a mean distance stands for all. In halls full of lamps half of its radius²
  // gave about the least variance.
  const Vector nearest_sq = hn::Max(hn::Mul(half, radius_sq), hn::Set(d, 1e-20f));
  const Vector base = hn::Div(column(11), hn::Max(distance_sq, nearest_sq));
  const Vector slack = hn::Set(d, CosineSlack());
  const Vector receiver = any_side ? one : averaged(cos_receiver, toward);
  // Beyond its cone, or wholly behind the surface.
  const auto dark =
      hn::Or(hn::Lt(cos_emission, hn::Sub(column(9), slack)), hn::Lt(cos_receiver, hn::Neg(slack)));
  return hn::IfThenZeroElse(dark, hn::Mul(hn::Mul(base, hn::Max(emission, slack)),
                                          hn::Max(receiver, hn::Set(d, minimum_receiver_cosine))));
}

float IrradianceOfOne(const float* ball, const Vec3f& reference, const Vec3f& normal) {
  const hn::CappedTag<float, 1> d;
  return hn::GetLane(irradiance_of(d, ball, 1, reference, normal));
}

void IrradianceOfMany(const float* balls, size_t stride, const Vec3f& reference,
                      const Vec3f& normal, float* result) {
  const hn::CappedTag<float, EmissionBalls::padding> d;
  for (size_t i = 0; i < stride; i += hn::Lanes(d))
    hn::StoreU(irradiance_of(d, balls + i, stride, reference, normal), d, result + i);
}

}  // namespace
}  // namespace kaustik::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kaustik {
namespace {
HWY_EXPORT(IrradianceOfOne);
HWY_EXPORT(IrradianceOfMany);

/// The order of EmissionBalls' columns.
std::array<float, EmissionBalls::column_count> numbers_of(const EmissionBall& b) {
  return {b.center.x, b.center.y,   b.center.z,   b.radius,      b.axis.x, b.axis.y,
          b.axis.z,   b.cos_spread, b.sin_spread, b.cos_falloff, b.ramp,   b.intensity};
}
}  // namespace

EmissionBall::EmissionBall(const LightBounds& bounds, double power)
    : EmissionBall(bounds.position, emission_cone(bounds),
                   power / orientation_measure(emission_cone(bounds))) {}

EmissionBall::EmissionBall(const Bounds3f& position, const EmissionCone& cone, double brightest)
    : center(kaustik::center(position)),
      radius(bounding_radius(position) * (1.0f + 1e-5f)),
      axis(cone.axis),
      cos_spread(float(std::cos(cone.spread))),
      sin_spread(float(std::sin(cone.spread))),
      cos_falloff(float(std::cos(cone.falloff))),
      intensity(std::max(float(brightest), std::numeric_limits<float>::min())) {}

float EmissionBall::irradiance(const Vec3f& reference, const Vec3f& normal) const {
  return HWY_DYNAMIC_DISPATCH(IrradianceOfOne)(numbers_of(*this).data(), reference, normal);
}

EmissionBalls::Block EmissionBalls::add(std::span<const EmissionBall> balls) {
  const size_t stride = padded(balls.size());
  const Block block{uint32_t(columns_.size()), uint32_t(balls.size())};
  columns_.resize(columns_.size() + column_count * stride, 0.0f);
  for (size_t i = 0; i < balls.size(); ++i) {
    const auto numbers = numbers_of(balls[i]);
    for (size_t k = 0; k < column_count; ++k) columns_[block.first + k * stride + i] = numbers[k];
  }
  return block;
}

void EmissionBalls::irradiance(const Block& block, const Vec3f& reference, const Vec3f& normal,
                               float* result) const {
  HWY_DYNAMIC_DISPATCH(IrradianceOfMany)
  (columns_.data() + block.first, padded(block.count), reference, normal, result);
}

}  // namespace kaustik
#endif
