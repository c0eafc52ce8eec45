#include "kaustik/light/slide.h"

#include <cmath>

#include "kaustik/base/warp.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Cells of the table along each side, and the share of rays that is spread over the whole picture:
/// what lies between the samples of a table may be bright.
constexpr int table_side = 256;
constexpr double spread_share = 0.1;

/// Directions at the rim meet it but for rounding.
constexpr float rim = 1e-5f;

}  // namespace

Slide::Slide(std::shared_ptr<const EmissionPattern> picture, const Vec2f& half_size,
             Outline outline, const Factor& factor)
    : picture_(std::move(picture)),
      half_size_(half_size),
      outline_(outline),
      distribution_(1, 1, {1}, 1) {
  std::vector<double> weights;
  constexpr float cell = 1.0f / table_side;
  for (int y = 0; y < table_side; ++y) {
    Spectrum of_row;  // a sum of few numbers loses few of their digits
    for (int x = 0; x < table_side; ++x) {
      const Vec2f square((float(x) + 0.5f) * cell, (float(y) + 0.5f) * cell);
      const Vec3f direction = direction_of(square);
      // A piece of the plane fills cos³ of its area as seen from the origin.
      const float per_area = factor(direction) * direction.z * direction.z * direction.z;
      const SurfacePoint place = place_of(plane_point_of(square));
      const Spectrum value = picture_ ? picture_->mean_about(place, cell) : Spectrum(1);
      of_row += value * per_area;
      weights.push_back(importance_of(value) * double(per_area));
    }
    integral_ += of_row;
  }
  integral_ *= area() * cell * cell;
  distribution_ = SquareDistribution(table_side, table_side, weights, spread_share);
}

Spectrum Slide::value(const Vec3f& local, const Wavelengths& wavelengths) const {
  Vec2f plane_point;
  if (!meet(local, plane_point)) return {};
  return picture_ ? picture_->radiance(place_of(plane_point), wavelengths) : Spectrum(1);
}

float Slide::cos_angle() const {
  const float x = half_size_.x * half_size_.x, y = half_size_.y * half_size_.y;
  return 1.0f / std::sqrt(1.0f + (outline_ == Outline::ellipse ? std::max(x, y) : x + y));
}

float Slide::pdf(const Vec3f& local) const {
  Vec2f plane_point;
  if (!meet(local, plane_point)) return 0;
  Vec2f square = outline_ == Outline::ellipse
                     ? disk_to_square(plane_point)
                     : Vec2f(0.5f * (1.0f + plane_point.x), 0.5f * (1.0f + plane_point.y));
  square = {std::clamp(square.x, 0.0f, 1.0f), std::clamp(square.y, 0.0f, 1.0f)};
  return distribution_.pdf(square) / (area() * local.z * local.z * local.z);
}

Vec2f Slide::plane_point_of(const Vec2f& square) const {
  return outline_ == Outline::ellipse ? square_to_disk(square)
                                      : Vec2f(2.0f * square.x - 1.0f, 2.0f * square.y - 1.0f);
}

Vec3f Slide::direction_of(const Vec2f& square) const {
  const Vec2f p = plane_point_of(square);
  return normalize(Vec3f(p.x * half_size_.x, p.y * half_size_.y, 1.0f));
}

float Slide::area() const {
  const float corners = std::fabs(half_size_.x * half_size_.y);
  return outline_ == Outline::ellipse ? pi * corners : 4.0f * corners;
}

bool Slide::meet(const Vec3f& local, Vec2f& plane_point) const {
  if (!(local.z > 0)) return false;
  plane_point = {local.x / (local.z * half_size_.x), local.y / (local.z * half_size_.y)};
  if (outline_ == Outline::ellipse)
    return plane_point.x * plane_point.x + plane_point.y * plane_point.y <= 1.0f + 2.0f * rim;
  return std::fabs(plane_point.x) <= 1.0f + rim && std::fabs(plane_point.y) <= 1.0f + rim;
}

SurfacePoint Slide::place_of(const Vec2f& plane_point) const {
  SurfacePoint place;
  place.uv = {std::clamp(0.5f * (1.0f + plane_point.x), 0.0f, 1.0f),
              std::clamp(0.5f * (1.0f + plane_point.y), 0.0f, 1.0f)};
  place.position = Vec3f(plane_point.x * half_size_.x, plane_point.y * half_size_.y, 1.0f);
  place.ng = place.ns = Vec3f(0, 0, 1);
  return place;
}

}  // namespace kaustik
