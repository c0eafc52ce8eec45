#include "kaustik/light/emission_cone.h"

namespace kaustik {
namespace {

double angle_between(const Vec3f& a, const Vec3f& b) {
  const Vec3d x(a), y(b);
  return std::atan2(x.cross(y).length(), x.dot(y));
}

/// `axis` turned by `angle` toward `target`; zero if they are opposite.
Vec3f turned_toward(const Vec3f& axis, const Vec3f& target, double angle) {
  const Vec3d a(axis), t(target);
  const Vec3d across = t - a * a.dot(t);
  if (!(across.length() > 1e-6)) return {0, 0, 0};
  return Vec3f(a * std::cos(angle) + across.normalized() * std::sin(angle)).normalized();
}

}  // namespace

EmissionCone emission_cone(const LightBounds& bounds) {
  EmissionCone cone;
  cone.axis = bounds.axis;
  cone.spread = std::acos(std::clamp(double(bounds.cos_spread), -1.0, 1.0));
  const double end = std::acos(std::clamp(double(bounds.cos_angle), -1.0, 1.0));
  cone.falloff = std::max(0.0, end - cone.spread);
  return cone;
}

EmissionCone united(const EmissionCone& a, const EmissionCone& b) {
  if (b.spread > a.spread) return united(b, a);
  EmissionCone result = a;
  result.falloff = std::max(a.falloff, b.falloff);
  const double between = angle_between(a.axis, b.axis);
  if (std::min(between + b.spread, std::numbers::pi) <= a.spread) return result;
  result.spread = 0.5 * (a.spread + between + b.spread);
  result.axis = turned_toward(a.axis, b.axis, result.spread - a.spread);
  if (result.spread < std::numbers::pi && length_sq(result.axis) > 0) return result;
  result.spread = std::numbers::pi;
  result.axis = a.axis;
  return result;
}

double orientation_measure(const EmissionCone& cone) {
  const double o = cone.spread, w = std::min(o + cone.falloff, std::numbers::pi);
  const double sin_half = std::sin(0.5 * o);
  const double inside = 4 * std::numbers::pi * sin_half * sin_half;
  const double beyond =
      0.5 * std::numbers::pi * (2 * (w - o) * std::sin(o) - std::cos(o - 2 * w) + std::cos(o));
  return std::max(inside + beyond, 1e-12);
}

}  // namespace kaustik
