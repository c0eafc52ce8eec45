#include "kaustik/geometry/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaustik {
namespace {

/// What rounding leaves of smaller solid angles is no density, sr.
constexpr double least_solid_angle = 1e-5;

}  // namespace

std::optional<SphericalRectangle> SphericalRectangle::make(const Vec3d& middle, const Vec3d& s,
                                                           const Vec3d& t) {
  SphericalRectangle result;
  result.half_x_ = s.length();
  result.half_y_ = t.length();
  const double size = result.half_x_ * result.half_y_;
  if (!(size > 0) || !std::isfinite(size) || std::fabs(s.dot(t)) > 1e-6 * size) return std::nullopt;
  result.middle_ = middle;
  result.x_ = s / result.half_x_;
  result.y_ = t / result.half_y_;
  result.z_ = result.x_.cross(result.y_);
  return result;
}

// Section 4 of the paper, with its names.
std::optional<SphericalRectangle::View> SphericalRectangle::seen_near(const Vec3f& reference,
                                                                      double ratio) const {
  const Vec3d d = middle_ - Vec3d(reference);
  if (d.length2() > ratio * ratio * (half_x_ * half_x_ + half_y_ * half_y_)) return std::nullopt;
  View view;
  view.x0_ = d.dot(x_) - half_x_;
  view.x1_ = view.x0_ + 2 * half_x_;
  view.y0_ = d.dot(y_) - half_y_;
  view.y1_ = view.y0_ + 2 * half_y_;
  view.z0_ = -std::fabs(d.dot(z_));
  if (!(view.z0_ < 0)) return std::nullopt;
  const auto edge_normal_z = [&](double v) { return -v / std::sqrt(v * v + view.z0_ * view.z0_); };
  // The normals of the planes through the point and an edge: those of edges along x lie in the yz
  // plane, those along y in the xz plane, so only their z components enter the angles.
  const double n0 = edge_normal_z(view.y0_), n2 = -edge_normal_z(view.y1_);
  const double n1 = -edge_normal_z(view.x1_), n3 = edge_normal_z(view.x0_);
  const auto angle = [](double a, double b) { return std::acos(std::clamp(-a * b, -1.0, 1.0)); };
  const double g0 = angle(n0, n1), g1 = angle(n1, n2), g2 = angle(n2, n3), g3 = angle(n3, n0);
  view.b0_ = n0;
  view.b1_ = n2;
  view.k_ = 2 * std::numbers::pi - g2 - g3;
  view.solid_angle_ = g0 + g1 - view.k_;
  if (!(view.solid_angle_ > least_solid_angle)) return std::nullopt;
  return view;
}

Vec2f SphericalRectangle::View::sample(const Vec2f& u) const {
  const double au = double(u.x) * solid_angle_ + k_;
  const double sine = std::sin(au);
  const double fu = (std::cos(au) * b0_ - b1_) / (sine != 0 ? sine : 1e-300);
  double cu = 1 / std::sqrt(fu * fu + b0_ * b0_) * (fu > 0 ? 1 : -1);
  cu = std::clamp(cu, -1.0, 1.0);
  const double xu = std::clamp(-(cu * z0_) / std::max(std::sqrt(1 - cu * cu), 1e-300), x0_, x1_);
  const double distance_sq = xu * xu + z0_ * z0_;
  const double h0 = y0_ / std::sqrt(distance_sq + y0_ * y0_),
               h1 = y1_ / std::sqrt(distance_sq + y1_ * y1_);
  const double hv = h0 + double(u.y) * (h1 - h0), hv_sq = hv * hv;
  const double yv =
      std::clamp(hv_sq < 1 ? hv * std::sqrt(distance_sq / (1 - hv_sq)) : y1_, y0_, y1_);
  return {float(2 * (xu - x0_) / (x1_ - x0_) - 1), float(2 * (yv - y0_) / (y1_ - y0_) - 1)};
}

}  // namespace kaustik
