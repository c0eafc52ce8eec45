#include "kaustik/volume/grid_crossing.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "kaustik/base/prefetch.h"

namespace kaustik {

GridCrossing::GridCrossing(const GridVolume& grid, const Vec3f& origin, const Vec3f& direction,
                           float to)
    : grid_(grid) {
  assert(grid.channels() == 1);
  const auto line = grid.line_in_box(origin, direction, 0, to);
  if (!line) return;
  line_ = *line;
  int region[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = std::clamp(int(line_.at[axis]), 0, grid.cells_[size_t(axis)] - 1);
    region[axis] = cell >> GridVolume::region_shift;
  }
  bounds_ = &grid.bounds_[grid.region_index(region[0], region[1], region[2])];
  const ptrdiff_t strides[3] = {1, ptrdiff_t(grid.region_index(0, 1, 0)),
                                ptrdiff_t(grid.region_index(0, 0, 1))};
  constexpr int size = 1 << GridVolume::region_shift;
  for (int axis = 0; axis < 3; ++axis) {
    if (line_.along[axis] == 0) continue;
    const bool is_forward = line_.along[axis] > 0;
    Ahead& ahead = ahead_[axis];
    ahead.boundary = float((region[axis] + (is_forward ? 1 : 0)) * size);
    ahead.to_boundary = float(is_forward ? size : -size);
    ahead.enters = (ahead.boundary - line_.at[axis]) * line_.inverse[axis];
    ahead.regions =
        is_forward ? grid.regions_along_[size_t(axis)] - 1 - region[axis] : region[axis];
    ahead.to_bounds = is_forward ? strides[axis] : -strides[axis];
    cells_per_length_ += std::fabs(line_.along[axis]);
  }
}

const float* GridCrossing::sample(float place, float& u) const {
  std::array<float, 3> at;
  for (size_t axis = 0; axis < 3; ++axis) at[axis] = line_.at[axis] + line_.along[axis] * place;
  const float* const sample = grid_.sample_in_cells(at, u);
  prefetch(sample);
  return sample;
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
