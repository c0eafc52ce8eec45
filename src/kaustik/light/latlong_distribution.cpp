#include "kaustik/light/latlong_distribution.h"

#include <algorithm>
#include <span>

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// The part of `cumulative` (from zero, ascending) that holds u, which becomes the place within it.
int pick(std::span<const double> cumulative, double& u) {
  const double target = u * cumulative.back();
  const auto end = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, target);
  const auto i = end - cumulative.begin() - 1;
  const double low = cumulative[size_t(i)], width = cumulative[size_t(i) + 1] - low;
  u = width > 0 ? std::clamp((target - low) / width, 0.0, 1.0) : 0.5;
  return int(i);
}

/// In [0, 1], with a density that goes linearly from a to b, not both zero.
double sample_linear(double u, double a, double b) {
  const double sum = a + std::sqrt(std::lerp(a * a, b * b, u));
  return sum > 0 ? std::min(u * (a + b) / sum, 1.0) : u;
}

}  // namespace

LatLongDistribution::LatLongDistribution(int width, std::vector<float> values, double last_angle)
    : width_(width),
      rows_(int(values.size() / size_t(width))),
      last_angle_(last_angle),
      values_(std::move(values)) {
  for (int r = 0; r < rows_; ++r) heights_.push_back(std::cos(last_angle_ * r / (rows_ - 1)));
  row_cumulative_.push_back(0);
  for (int r = 0; r + 1 < rows_; ++r) {
    const double cell_solid_angle =
        2 * std::numbers::pi / width_ * (heights_[size_t(r)] - heights_[size_t(r) + 1]);
    double sum = 0;
    cumulative_.push_back(0);
    for (int c = 0; c < width_; ++c)
      cumulative_.push_back(sum += corners(r, c).mean() * cell_solid_angle);
    row_cumulative_.push_back(integral_ += sum);
  }
}

LatLongDistribution::Corners LatLongDistribution::corners(int row, int column) const {
  const int next = column + 1 < width_ ? column + 1 : 0;
  const float* upper = &values_[size_t(row) * size_t(width_)];
  const float* lower = upper + width_;
  return {upper[column], upper[next], lower[column], lower[next]};
}

int LatLongDistribution::row_of(double height) const {
  const double angle = std::acos(std::clamp(height, -1.0, 1.0));
  int row = to_integer(angle / last_angle_ * (rows_ - 1), 0, rows_ - 2);
  // The rounding of the angle must not put a height outside of its cell.
  while (row > 0 && height > heights_[size_t(row)]) --row;
  while (row < rows_ - 2 && height < heights_[size_t(row) + 1]) ++row;
  return row;
}

LatLong LatLongDistribution::sample(const Vec2f& u) const {
  double u_turn = double(u.x), u_height = double(u.y);
  const int row = pick(row_cumulative_, u_height);
  const size_t cells = size_t(width_) + 1;
  const int column = pick(std::span(cumulative_).subspan(size_t(row) * cells, cells), u_turn);
  const Corners v = corners(row, column);
  const double t = sample_linear(u_height, v.v00 + v.v10, v.v01 + v.v11);
  const double s = sample_linear(u_turn, std::lerp(v.v00, v.v01, t), std::lerp(v.v10, v.v11, t));
  LatLong at;
  at.turn = (column + 0.5 + s) / width_;
  at.turn -= std::floor(at.turn);
  at.height = std::lerp(heights_[size_t(row)], heights_[size_t(row) + 1], t);
  return at;
}

float LatLongDistribution::pdf(const LatLong& at) const {
  if (!(integral_ > 0) || at.height < heights_.back()) return 0;
  const int row = row_of(at.height);
  const double x = at.turn * width_ - 0.5, left = std::floor(x);
  const int column = left < 0 ? width_ - 1 : to_integer(left, 0, width_ - 1);
  const Corners v = corners(row, column);
  const double s = x - left;
  const double t =
      (heights_[size_t(row)] - at.height) / (heights_[size_t(row)] - heights_[size_t(row) + 1]);
  return float(std::lerp(std::lerp(v.v00, v.v10, s), std::lerp(v.v01, v.v11, s), t) / integral_);
}

}  // namespace kaustik
