// Straight lines through grids: from brick to brick, and in those that are not uniform from cell to
// cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987).

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "kaustik/base/spectrum.h"
#include "kaustik/volume/grid_volume.h"

namespace kaustik {
namespace {

using Lanes = Spectrum::Register;

Lanes all_lanes(float value) { return Lanes{value, value, value, value}; }

/// Two neighbours along x, and two others.
Lanes two_pairs(const float* a, const float* b) {
  using Doubles = double __attribute__((vector_size(16)));
  double first, second;
  std::memcpy(&first, a, sizeof(first));
  std::memcpy(&second, b, sizeof(second));
  return Lanes(Doubles{first, second});
}

/// The first and the third lane of both, and the second and the fourth.
Lanes even_lanes(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 2, 4, 6); }
Lanes odd_lanes(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 1, 3, 5, 7); }

/// Where the samples around a cell lie in memory.
struct Corners {
  const float* first;
  int to_y, to_z;
};

/// The mean of the trilinear function over a line within the cell, whose middle is (x, y, z). With
/// Δ the line from end to end it is that at the middle, plus (f_xy Δx Δy + f_xz Δx Δz + f_yz Δy
/// Δz)/12 by the mixed derivatives there; what else there is vanishes by symmetry. `products`: 0,
/// Δx Δz/12, Δy Δz/12, Δx Δy/12.
float mean_along(const Corners& at, float x, float y, float z, Lanes products) {
  const Lanes near = two_pairs(at.first, at.first + at.to_y);
  const Lanes far = two_pairs(at.first + at.to_z, at.first + at.to_z + at.to_y);
  // Of the four edges along x: values there, and slopes.
  const Lanes before = even_lanes(near, far), slope_x = odd_lanes(near, far) - before;
  const Lanes values = before + slope_x * all_lanes(x);
  // Along y: values and slopes by x of the near and of the far face, and how they rise.
  const Lanes low = even_lanes(values, slope_x), slope_y = odd_lanes(values, slope_x) - low;
  const Lanes of_faces = low + slope_y * all_lanes(y);
  // Along z: f and f_x, f_y and f_xy of the near face; how they rise: f_z, f_xz, f_yz, f_xyz.
  const Lanes of_near = even_lanes(of_faces, slope_y);
  const Lanes slope_z = odd_lanes(of_faces, slope_y) - of_near;
  const Lanes there = of_near + slope_z * all_lanes(z);
  const Lanes terms = __builtin_shufflevector(there, slope_z, 0, 5, 6, 3) * products;
  return there[0] + ((terms[1] + terms[2]) + terms[3]);
}

/// The values of the trilinear function at four places of the cell.
Lanes values_at(const Corners& at, Lanes x, Lanes y, Lanes z) {
  const auto along_x = [&](const float* from) {
    return x * all_lanes(from[1] - from[0]) + all_lanes(from[0]);
  };
  const Lanes a = along_x(at.first), b = along_x(at.first + at.to_y);
  const Lanes c = along_x(at.first + at.to_z), d = along_x(at.first + at.to_z + at.to_y);
  const Lanes near = a + (b - a) * y, far = c + (d - c) * y;
  return near + (far - near) * z;
}

/// Where in [0, 1] the integral of a polynomial of degree 3, nowhere negative, comes to `target`.
/// It is given by its values at 0, ¼, ½ and 1. Newton's method, within bounds that close in.
float reach_in_cell(const Lanes& values, double target) {
  const double a = double(values[0]);
  const double end = double(values[3]) - a, middle = 8 * (double(values[2]) - a),
               quarter = 64 * (double(values[1]) - a);
  const double b = quarter / 6 - middle / 2 + end / 3;
  const double c = middle - end - 3 * b;
  const double d = end - b - c;
  const auto excess = [&](double x) {
    return x * (a + x * (b / 2 + x * (c / 3 + x * d / 4))) - target;
  };
  const auto slope = [&](double x) { return a + x * (b + x * (c + x * d)); };
  const double whole = excess(1) + target;
  if (!(whole > 0)) return 1;
  double low = 0, high = 1, x = std::clamp(target / whole, 0.0, 1.0);
  constexpr int most_steps = 40;
  for (int i = 0; i < most_steps; ++i) {
    const double error = excess(x);
    if (std::fabs(error) <= 1e-9 * whole) break;
    (error > 0 ? high : low) = x;
    const double rise = slope(x);
    const double next = rise > 0 ? x - error / rise : -1;
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return float(x);
}

}  // namespace

std::optional<GridVolume::Line> GridVolume::line_in_box(const Vec3f& origin, const Vec3f& direction,
                                                        float from, float to) const {
  double at[3], along[3], begin = double(from), end = double(to);
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto& row = cells_from_world_[axis];
    at[axis] = in_cells(origin, int(axis));
    along[axis] =
        row[0] * double(direction.x) + row[1] * double(direction.y) + row[2] * double(direction.z);
    const double low = double(margin_), high = low + double(size_[axis]);
    if (along[axis] == 0) {
      if (!(at[axis] >= low && at[axis] <= high)) return std::nullopt;
      continue;
    }
    const double a = (low - at[axis]) / along[axis], b = (high - at[axis]) / along[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end) || !std::isfinite(end)) return std::nullopt;
  Line line;
  line.begin = float(begin);
  line.length = float(end - begin);
  for (size_t axis = 0; axis < 3; ++axis) {
    line.at[axis] = float(at[axis] + along[axis] * begin);
    // Less would take all that there is to leave the cell, and has no inverse.
    constexpr double least = 1e-30;
    line.along[axis] = std::fabs(along[axis]) < least ? 0.0f : float(along[axis]);
    line.inverse[axis] = line.along[axis] == 0 ? 0.0f : 1 / line.along[axis];
  }
  return line;
}

/// Calls `step` with every piece of the line, and a function that gives the values at the begin of
/// the piece, after a quarter and a half of it, and at its end; until that answers false.
template <bool trilinear, typename Step>
void GridVolume::walk(const Line& line, const Step& step) const {
  // Where the line crosses the plane of cells before `boundary`.
  const auto crossing = [&](int axis, int boundary) {
    return (float(boundary) - line.at[axis]) * line.inverse[axis];
  };
  const float* along = line.along;
  const Lanes products = Lanes{0, along[0] * along[2], along[1] * along[2], along[0] * along[1]} *
                         all_lanes(1.0f / 12);
  Corners corners{nullptr, sides_[0], sides_[0] * sides_[1]};
  const int stride[3] = {1, corners.to_y, corners.to_z};
  int cell[3], forward[3];
  for (int axis = 0; axis < 3; ++axis) {
    cell[axis] = std::clamp(int(line.at[axis]), 0, cells_[size_t(axis)] - 1);
    forward[axis] = along[axis] > 0 ? 1 : 0;
  }
  float at = 0;
  while (true) {
    int brick[3], exit_axis = -1;
    float exit = line.length;
    for (int axis = 0; axis < 3; ++axis) {
      brick[axis] = cell[axis] >> brick_shift;
      if (along[axis] == 0) continue;
      const float leaves = crossing(axis, (brick[axis] + forward[axis]) << brick_shift);
      if (leaves < exit) exit = leaves, exit_axis = axis;
    }
    exit = std::max(exit, at);
    const Brick& in = bricks_[brick_index(brick[0], brick[1], brick[2])];
    if (in.block == uniform) {
      const auto values = [&] { return all_lanes(in.value); };
      if (exit > at && !step(Piece{at, exit, in.value * (exit - at)}, values)) return;
    } else {
      corners.first = values_.data() + size_t(in.block) * block_values();
      int local[3];
      float next[3], begin[3];  // where the line would be in the cell at t = 0
      for (int axis = 0; axis < 3; ++axis) {
        local[axis] = cell[axis] - (brick[axis] << brick_shift);
        corners.first += local[axis] * stride[axis];
        begin[axis] = line.at[axis] - float(cell[axis]);
        next[axis] = along[axis] == 0 ? infinity : crossing(axis, cell[axis] + forward[axis]);
      }
      while (true) {
        // Which one it is nobody can predict: without branches.
        int axis = next[1] < next[0] ? 1 : 0;
        axis = next[2] < next[axis] ? 2 : axis;
        const float end = std::min(next[axis], exit);
        if (end > at) {
          const float length = end - at;
          bool goes_on;
          if constexpr (trilinear) {
            const float middle = 0.5f * (at + end);
            const float mean =
                mean_along(corners, along[0] * middle + begin[0], along[1] * middle + begin[1],
                           along[2] * middle + begin[2], products * all_lanes(length * length));
            goes_on = step(Piece{at, end, length * mean}, [&] {
              const Lanes t = Lanes{0, 0.25f, 0.5f, 1} * all_lanes(length) + all_lanes(at);
              const auto place = [&](int of) {
                return t * all_lanes(along[of]) + all_lanes(begin[of]);
              };
              return values_at(corners, place(0), place(1), place(2));
            });
          } else {
            goes_on = step(Piece{at, end, length * *corners.first},
                           [&] { return all_lanes(*corners.first); });
          }
          if (!goes_on) return;
          at = end;
        }
        if (!(next[axis] < exit)) break;
        const int to = forward[axis] ? 1 : -1;
        cell[axis] += to;
        local[axis] += to;
        // What is beyond the block is not there, wherever rounding leads.
        if (local[axis] < 0 || local[axis] >= sides_[size_t(axis)] - (trilinear ? 1 : 0)) break;
        corners.first += to * stride[axis];
        begin[axis] = line.at[axis] - float(cell[axis]);
        next[axis] = crossing(axis, cell[axis] + forward[axis]);
      }
    }
    at = exit;
    if (exit_axis < 0) return;
    brick[exit_axis] += forward[exit_axis] ? 1 : -1;
    if (brick[exit_axis] < 0 || brick[exit_axis] >= bricks_along_[size_t(exit_axis)]) return;
    for (int axis = 0; axis < 3; ++axis) {
      const int first = brick[axis] << brick_shift;
      const int last = std::min(first + brick_size, cells_[size_t(axis)]) - 1;
      cell[axis] = axis == exit_axis
                       ? (forward[axis] ? first : last)
                       : std::clamp(int(line.at[axis] + along[axis] * at), first, last);
    }
  }
}

template <typename Step>
void GridVolume::walk(const Line& line, const Step& step) const {
  assert(channels_ == 1);
  if (filter_ == Filter::trilinear)
    walk<true>(line, step);
  else
    walk<false>(line, step);
}

float GridVolume::integral(const Line& line, float enough) const {
  double sum = 0;
  walk(line, [&](const Piece& piece, const auto&) {
    sum += double(piece.integral);
    return sum <= double(enough);
  });
  return float(std::max(0.0, sum));
}

float GridVolume::integral(const Vec3f& origin, const Vec3f& direction, float from, float to,
                           float enough) const {
  const auto line = line_in_box(origin, direction, from, to);
  return line ? integral(*line, enough) : 0;
}

GridVolume::Reach GridVolume::reach(const Line& line, float target) const {
  double sum = 0;
  Reach result;
  walk(line, [&](const Piece& piece, const auto& values) {
    const double after = sum + double(piece.integral);
    result.is_reached = after > double(target);
    if (!result.is_reached) {
      sum = after;
      return true;
    }
    const double length = double(piece.end) - double(piece.begin);
    const float share = reach_in_cell(values(), (double(target) - sum) / length);
    result.distance = piece.begin + share * float(length);
    return false;
  });
  result.integral = float(std::max(0.0, sum));
  return result;
}

GridVolume::Reach GridVolume::reach(const Vec3f& origin, const Vec3f& direction, float to,
                                    float target) const {
  const auto line = line_in_box(origin, direction, 0, to);
  if (!line) return {};
  Reach result = reach(*line, target);
  result.distance += line->begin;
  return result;
}

void GridVolume::measure(const Vec3f& origin, const Vec3f& direction, float to,
                         std::vector<LineKnot>& knots) const {
  double sum = 0;
  const auto line = line_in_box(origin, direction, 0, to);
  if (!line) return;
  knots.push_back({line->begin, 0});
  walk(*line, [&](const Piece& piece, const auto&) {
    sum += double(piece.integral);
    knots.push_back({line->begin + piece.end, float(sum)});
    return true;
  });
}

}  // namespace kaustik
