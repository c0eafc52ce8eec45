#include "kaustik/volume/grid_crossing.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kaustik {

GridCrossing::GridCrossing(const GridVolume& grid, const Vec3f& origin, const Vec3f& direction,
                           float to)
    : grid_(grid) {
  assert(grid.channels() == 1);
  const auto line = grid.line_in_box(origin, direction, 0, to);
  if (!line) return;
  line_ = *line;
  is_over_ = false;
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = std::clamp(int(line_.at[axis]), 0, grid.cells_[size_t(axis)] - 1);
    region_[axis] = cell >> GridVolume::region_shift;
    forward_[axis] = line_.along[axis] > 0 ? 1 : 0;
    cells_per_length_ += std::fabs(line_.along[axis]);
  }
}

bool GridCrossing::next(Piece& piece) {
  while (!is_over_) {
    float exit = line_.length;
    int exit_axis = -1;
    for (int axis = 0; axis < 3; ++axis) {
      if (line_.along[axis] == 0) continue;
      const auto boundary = float((region_[axis] + forward_[axis]) << GridVolume::region_shift);
      const float leaves = (boundary - line_.at[axis]) * line_.inverse[axis];
      if (leaves < exit) exit = leaves, exit_axis = axis;
    }
    const float begin = at_;
    at_ = std::max(exit, begin);
    const GridVolume::Bounds& bounds =
        grid_.bounds_[grid_.region_index(region_[0], region_[1], region_[2])];
    if (exit_axis >= 0) {
      int& region = region_[exit_axis];
      region += forward_[exit_axis] ? 1 : -1;
      is_over_ = region < 0 || region >= grid_.regions_along_[size_t(exit_axis)];
    } else {
      is_over_ = true;
    }
    if (at_ > begin && (bounds.least != 0 || bounds.largest != 0)) {
      piece = {begin, at_, bounds.least, bounds.largest, 1 + (at_ - begin) * cells_per_length_};
      return true;
    }
  }
  return false;
}

float GridCrossing::value(const Piece& piece, float place) const {
  std::array<float, 3> at;
  for (size_t axis = 0; axis < 3; ++axis) at[axis] = line_.at[axis] + line_.along[axis] * place;
  // Rounding may take it beyond the end of its region.
  return std::clamp(grid_.value_in_cells(at, 0), piece.least, piece.largest);
}

GridVolume::Line GridCrossing::part(const Piece& piece) const {
  GridVolume::Line result = line_;
  for (int axis = 0; axis < 3; ++axis) result.at[axis] += result.along[axis] * piece.begin;
  result.length = piece.end - piece.begin;
  return result;
}

float GridCrossing::integral(const Piece& piece) const {
  return grid_.integral(part(piece), infinity);
}

GridVolume::Reach GridCrossing::reach(const Piece& piece, float target) const {
  GridVolume::Reach result = grid_.reach(part(piece), target);
  result.distance = std::min(result.distance + piece.begin, piece.end);
  return result;
}

}  // namespace kaustik
