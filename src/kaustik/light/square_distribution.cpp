#include "kaustik/light/square_distribution.h"

#include <algorithm>
#include <cmath>

namespace kaustik {
namespace {

/// Which of the parts of [0, 1) that end there holds `u`, and where in it, from 0 to 1.
std::pair<size_t, float> part_of(const double* ends, size_t count, double u) {
  const double* const end = std::upper_bound(ends, ends + count - 1, u);
  const auto part = size_t(end - ends);
  const double low = part > 0 ? ends[part - 1] : 0.0;
  const double within = *end > low ? (u - low) / (*end - low) : 0.5;
  return {part, std::clamp(float(within), 0.0f, one_minus_epsilon)};
}

/// Sums of `shares` so far, over all of them.
void append_ends(const std::vector<double>& shares, std::vector<double>& ends) {
  double sum = 0, so_far = 0;
  for (const double share : shares) sum += share;
  for (const double share : shares) ends.push_back((so_far += share) / sum);
  ends.back() = 1;
}

}  // namespace

SquareDistribution::SquareDistribution(int width, int height, const std::vector<double>& weights,
                                       double uniform_share)
    : width_(width), height_(height) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  if (!(sum > 0)) uniform_share = 1;
  const double cells = double(width) * height;
  std::vector<double> rows, row;
  for (int y = 0; y < height; ++y) {
    row.clear();
    double of_row = 0;
    for (int x = 0; x < width; ++x) {
      const double weight = sum > 0 ? weights[size_t(y) * size_t(width) + size_t(x)] / sum : 0.0;
      row.push_back((1 - uniform_share) * weight + uniform_share / cells);
      of_row += row.back();
      density_.push_back(float(row.back() * cells));
    }
    append_ends(row, cell_ends_);
    rows.push_back(of_row);
  }
  append_ends(rows, row_ends_);
}

Vec2f SquareDistribution::sample(const Vec2f& u, float& density) const {
  const auto [row, v] = part_of(row_ends_.data(), size_t(height_), double(u.y));
  const auto [column, w] =
      part_of(cell_ends_.data() + row * size_t(width_), size_t(width_), double(u.x));
  density = density_[row * size_t(width_) + column];
  return {std::min((float(column) + w) / float(width_), one_minus_epsilon),
          std::min((float(row) + v) / float(height_), one_minus_epsilon)};
}

float SquareDistribution::pdf(const Vec2f& p) const {
  if (!(p.x >= 0 && p.y >= 0 && p.x <= 1 && p.y <= 1)) return 0;
  const size_t x = size_t(std::min(int(p.x * float(width_)), width_ - 1));
  const size_t y = size_t(std::min(int(p.y * float(height_)), height_ - 1));
  return density_[y * size_t(width_) + x];
}

}  // namespace kaustik
