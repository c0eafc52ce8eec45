#include "kaustik/geometry/grid_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kaustik {
namespace {

double mix(double a, double b, double t) { return a + (b - a) * t; }

/// Steps through the cells of a grid of cubes that a ray meets (Amanatides and Woo, "A Fast Voxel
/// Traversal Algorithm for Ray Tracing", Eurographics 1987).
class CellWalk {
 public:
  /// Between `begin` and `end`; the cells are `width` wide, and there are `count` along each axis.
  CellWalk(const Vec3d& from, const Vec3d& direction, double begin, double end, double width,
           const std::array<int, 3>& first, const std::array<int, 3>& last)
      : begin_(begin), end_(end), first_(first), last_(last) {
    const Vec3d p = from + direction * begin;
    for (int i = 0; i < 3; ++i) {
      const auto axis = size_t(i);
      cell[axis] = std::clamp(int(std::floor(p[i] / width)), first[axis], last[axis]);
      step_[axis] = direction[i] > 0 ? 1 : -1;
      const double speed = std::fabs(direction[i]);
      const double border = (cell[axis] + (direction[i] > 0 ? 1 : 0)) * width;
      next_[axis] = speed > 0 ? (border - from[i]) / direction[i] : infinity_;
      delta_[axis] = speed > 0 ? width / speed : infinity_;
    }
  }

  std::array<int, 3> cell;
  /// What the ray has in the cell.
  double begin() const { return begin_; }
  double end() const { return std::max(begin_, std::min(end_, next_[nearest()])); }
  /// False: there is no further cell.
  bool advance() {
    const size_t axis = nearest();
    if (!(next_[axis] < end_)) return false;
    begin_ = std::max(begin_, next_[axis]);
    next_[axis] += delta_[axis];
    cell[axis] += step_[axis];
    return cell[axis] >= first_[axis] && cell[axis] <= last_[axis];
  }

 private:
  static constexpr double infinity_ = std::numeric_limits<double>::infinity();
  size_t nearest() const {
    if (next_[0] <= next_[1]) return next_[0] <= next_[2] ? 0 : 2;
    return next_[1] <= next_[2] ? 1 : 2;
  }

  double begin_, end_;
  std::array<int, 3> first_, last_, step_;
  std::array<double, 3> next_, delta_;
};

/// The values of t, in order, where the cubic has no slope; fewer than two where there are none.
int flat_places(const std::array<double, 4>& c, std::array<double, 2>& places) {
  const double a = 3 * c[3], b = 2 * c[2], d = c[1];
  const double discriminant = b * b - 4 * a * d;
  if (!(discriminant > 0)) return 0;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  int count = 0;
  for (const auto& [above, below] : {std::pair(q, a), std::pair(d, q)})
    if (below != 0) places[size_t(count++)] = above / below;
  if (count == 2 && places[0] > places[1]) std::swap(places[0], places[1]);
  return count;
}

double cubic(const std::array<double, 4>& c, double t) {
  return ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
}

}  // namespace

GridField::GridField(const std::array<int, 3>& size, std::vector<float> values)
    : size_(size), values_(std::move(values)) {
  for (size_t i = 0; i < 3; ++i) blocks_[i] = (size_[i] - 2) / block_size + 1;
  block_is_used_.assign(size_t(blocks_[0]) * size_t(blocks_[1]) * size_t(blocks_[2]), false);
  for (int z = 0; z + 1 < size_[2]; ++z)
    for (int y = 0; y + 1 < size_[1]; ++y)
      for (int x = 0; x + 1 < size_[0]; ++x) {
        if (!may_cross({x, y, z})) continue;
        cells_.push_back({x, y, z});
        block_is_used_[(size_t(z / block_size) * size_t(blocks_[1]) + size_t(y / block_size)) *
                           size_t(blocks_[0]) +
                       size_t(x / block_size)] = true;
      }
}

bool GridField::may_cross(const Cell& cell) const {
  bool any_negative = false, any_other = false;
  for (int z = cell[2]; z <= cell[2] + 1; ++z)
    for (int y = cell[1]; y <= cell[1] + 1; ++y)
      for (int x = cell[0]; x <= cell[0] + 1; ++x)
        (values_[node_index(x, y, z)] < 0 ? any_negative : any_other) = true;
  return any_negative && any_other;
}

GridField::Corners GridField::corners_of(const Cell& cell) const {
  Corners corners;
  for (size_t i = 0; i < 8; ++i)
    corners[i] = node(cell[0] + int(i & 1), cell[1] + int(i >> 1 & 1), cell[2] + int(i >> 2));
  return corners;
}

GridField::Cell GridField::cell_at(const Vec3d& p, Vec3d& within) const {
  Cell cell;
  for (int i = 0; i < 3; ++i) {
    const int last = size_[size_t(i)] - 2;
    const double at = std::clamp(p[i], 0.0, double(last + 1));
    cell[size_t(i)] = std::min(int(at), last);
    within[i] = at - cell[size_t(i)];
  }
  return cell;
}

double GridField::value(const Vec3d& p) const {
  Vec3d w;
  const Corners c = corners_of(cell_at(p, w));
  const auto along_x = [&](size_t i) { return mix(c[i], c[i + 1], w.x); };
  return mix(mix(along_x(0), along_x(2), w.y), mix(along_x(4), along_x(6), w.y), w.z);
}

Vec3d GridField::gradient(const Vec3d& p) const {
  Vec3d w;
  const Corners c = corners_of(cell_at(p, w));
  // The differences along the four edges of each axis, between the two others.
  const auto slope = [&](size_t along, size_t u, size_t v) {
    const auto edge = [&](size_t i) { return c[i + along] - c[i]; };
    const auto part = [&](size_t bit) { return bit == 1 ? w.x : bit == 2 ? w.y : w.z; };
    return mix(mix(edge(0), edge(u), part(u)), mix(edge(v), edge(u + v), part(u)), part(v));
  };
  return {slope(1, 2, 4), slope(2, 1, 4), slope(4, 1, 2)};
}

Vec3d GridField::node_gradient(int x, int y, int z) const {
  const Cell at = {x, y, z};
  Vec3d gradient;
  for (size_t axis = 0; axis < 3; ++axis) {
    Cell low = at, high = at;
    low[axis] = std::max(0, at[axis] - 1);
    high[axis] = std::min(size_[axis] - 1, at[axis] + 1);
    gradient[int(axis)] = (node(high[0], high[1], high[2]) - node(low[0], low[1], low[2])) /
                          double(high[axis] - low[axis]);
  }
  return gradient;
}

Vec3d GridField::smooth_gradient(const Vec3d& p) const {
  Vec3d w;
  const Cell cell = cell_at(p, w);
  Vec3d sum(0, 0, 0);
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
    const double weight = (x ? w.x : 1 - w.x) * (y ? w.y : 1 - w.y) * (z ? w.z : 1 - w.z);
    sum += node_gradient(cell[0] + x, cell[1] + y, cell[2] + z) * weight;
  }
  return sum;
}

std::optional<double> GridField::crossing(const Vec3d& from, const Vec3d& direction,
                                          double t_max) const {
  double begin = 0, end = t_max;
  const Vec3d high = extent();
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (!(from[i] >= 0 && from[i] <= high[i])) return std::nullopt;
      continue;
    }
    const double a = -from[i] / direction[i], b = (high[i] - from[i]) / direction[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return std::nullopt;
  bool is_negative = value(from + direction * begin) < 0;
  const std::array<int, 3> last_block = {blocks_[0] - 1, blocks_[1] - 1, blocks_[2] - 1};
  CellWalk blocks(from, direction, begin, end, block_size, {0, 0, 0}, last_block);
  do {
    if (!block_is_used(blocks.cell)) continue;
    Cell first, last;
    for (size_t i = 0; i < 3; ++i) {
      first[i] = blocks.cell[i] * block_size;
      last[i] = std::min(first[i] + block_size, size_[i] - 1) - 1;
    }
    CellWalk cells(from, direction, blocks.begin(), blocks.end(), 1, first, last);
    do {
      const auto next = [&] {
        return crossing_in(cells.cell, from, direction, cells.begin(), cells.end(), is_negative);
      };
      std::optional<double> t = next();
      if (t && !(*t > 0)) {
        // The begin lies so near to the surface that its sign depends on how it is computed.
        is_negative = !is_negative;
        t = next();
      }
      if (t && *t > 0) return *t < t_max ? t : std::nullopt;
    } while (cells.advance());
  } while (blocks.advance());
  return std::nullopt;
}

std::optional<double> GridField::crossing_in(const Cell& cell, const Vec3d& from,
                                             const Vec3d& direction, double begin, double end,
                                             bool is_negative) const {
  const Corners v = corners_of(cell);
  const bool all_before =
      std::all_of(v.begin(), v.end(), [&](double value) { return (value < 0) == is_negative; });
  if (all_before) return std::nullopt;
  // The trilinear value along the ray, a cubic in the distance from its begin in the cell.
  const Vec3d o = from + direction * begin - Vec3d(cell[0], cell[1], cell[2]);
  const double k1 = v[1] - v[0], k2 = v[2] - v[0], k4 = v[4] - v[0];
  const double k3 = v[3] - v[2] - k1, k5 = v[5] - v[4] - k1, k6 = v[6] - v[4] - k2;
  const double k7 = v[7] - v[6] - v[5] + v[4] - k3;
  const double xy = o.x * o.y, xy1 = o.x * direction.y + o.y * direction.x;
  const double xy2 = direction.x * direction.y;
  const double m1 = k1 + k5 * o.z, m2 = k2 + k6 * o.z, m3 = k3 + k7 * o.z;
  const std::array<double, 4> c = {
      v[0] + k4 * o.z + o.x * m1 + o.y * m2 + xy * m3,
      direction.x * m1 + direction.y * m2 + xy1 * m3 +
          direction.z * (k4 + k5 * o.x + k6 * o.y + k7 * xy),
      xy2 * m3 + direction.z * (k5 * direction.x + k6 * direction.y + k7 * xy1),
      k7 * xy2 * direction.z};

  // Between the places without slope it goes one way only.
  const double length = end - begin;
  std::array<double, 2> flat{};
  const int flats = flat_places(c, flat);
  double low = 0;
  for (int i = 0; i <= flats; ++i) {
    const double high = i < flats ? flat[size_t(i)] : length;
    if (!(high > low || i == flats) || high > length) continue;
    // Where the value is not that of the sign before any more; at once, if rounding has lost it at
    // the border of the cell before.
    if ((cubic(c, low) < 0) != is_negative) return begin + low;
    if ((cubic(c, high) < 0) == is_negative) {
      low = high;
      continue;
    }
    double a = low, b = high;
    for (int step = 0; step < 60 && b - a > 1e-14 * length; ++step) {
      const double middle = 0.5 * (a + b);
      ((cubic(c, middle) < 0) == is_negative ? a : b) = middle;
    }
    return begin + a;
  }
  return std::nullopt;
}

std::vector<Imath::Box3d> GridField::surface_boxes(int budget) const {
  struct Part {
    size_t begin, end;
    Cell low, high;
    int width() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
  };
  std::vector<Cell> cells = cells_;
  const auto part_of = [&](size_t begin, size_t end) {
    Part part{begin, end, cells[begin], cells[begin]};
    for (size_t i = begin; i < end; ++i)
      for (size_t axis = 0; axis < 3; ++axis) {
        part.low[axis] = std::min(part.low[axis], cells[i][axis]);
        part.high[axis] = std::max(part.high[axis], cells[i][axis]);
      }
    return part;
  };
  const auto narrower = [](const Part& a, const Part& b) { return a.width() < b.width(); };
  std::vector<Part> parts;  // a heap, the widest first
  if (!cells.empty()) parts.push_back(part_of(0, cells.size()));
  while (!parts.empty() && parts.size() < size_t(std::max(1, budget)) &&
         parts.front().width() > 0) {
    std::pop_heap(parts.begin(), parts.end(), narrower);
    const Part part = parts.back();
    parts.pop_back();
    size_t axis = 0;
    for (const size_t other : {size_t{1}, size_t{2}})
      if (part.high[other] - part.low[other] > part.high[axis] - part.low[axis]) axis = other;
    const int middle = (part.low[axis] + part.high[axis]) / 2;
    const auto first = cells.begin() + std::ptrdiff_t(part.begin);
    const auto last = cells.begin() + std::ptrdiff_t(part.end);
    const auto cut =
        size_t(std::partition(first, last, [&](const Cell& c) { return c[axis] <= middle; }) -
               cells.begin());
    for (const Part& half : {part_of(part.begin, cut), part_of(cut, part.end)}) {
      parts.push_back(half);
      std::push_heap(parts.begin(), parts.end(), narrower);
    }
  }
  std::vector<Imath::Box3d> boxes;
  for (const Part& part : parts)
    boxes.emplace_back(Vec3d(part.low[0], part.low[1], part.low[2]),
                       Vec3d(part.high[0] + 1, part.high[1] + 1, part.high[2] + 1));
  return boxes;
}

}  // namespace kaustik
