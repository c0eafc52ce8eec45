#include "kit/field.h"

#include <stdexcept>

namespace kaustik::scenes {

double distance_to_ball(const Vec3d& p, const Vec3d& center, double radius) {
  return (p - center).length() - radius;
}

double distance_to_ellipsoid(const Vec3d& p, const Vec3d& center, const Vec3d& radii) {
  const Vec3d q = (p - center) / radii;
  const double k = q.length();
  if (k == 0) return -std::min({radii.x, radii.y, radii.z});
  return k * (k - 1) / (q / radii).length();
}

double distance_to_bar(const Vec3d& p, const Vec3d& a, double radius_a, const Vec3d& b,
                       double radius_b) {
  const Vec3d along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.length2(), 0.0, 1.0);
  return (p - a - along * t).length() - (radius_a + t * (radius_b - radius_a));
}

double distance_to_box(const Vec3d& p, const Vec3d& center, const Vec3d& half, double rounding) {
  const Vec3d d = p - center;
  const Vec3d q(std::fabs(d.x) - half.x + rounding, std::fabs(d.y) - half.y + rounding,
                std::fabs(d.z) - half.z + rounding);
  const Vec3d outside(std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0));
  return outside.length() + std::min(std::max({q.x, q.y, q.z}), 0.0) - rounding;
}

double blended(double a, double b, double blend) {
  // The polynomial smooth minimum: a parabola where the two distances differ by less than `blend`.
  const double h = std::max(blend - std::fabs(a - b), 0.0) / blend;
  return std::min(a, b) - 0.25 * h * h * blend;
}

double carved(double a, double b, double blend) { return -blended(-a, b, blend); }

namespace {

Vec3d gradient(const Field& field, const Vec3d& p, double step) {
  Vec3d g;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d d(0.0);
    d[axis] = step;
    g[axis] = (field(p + d) - field(p - d)) / (2 * step);
  }
  return g;
}

/// Samples of a field at the corners of a grid of cells.
class Grid {
 public:
  Grid(const Field& field, const Vec3d& low, const Vec3d& high, double cell)
      : low_(low), cell_(cell) {
    for (int axis = 0; axis < 3; ++axis)
      count_[size_t(axis)] = size_t(std::ceil((high[axis] - low[axis]) / cell)) + 1;
    values_.reserve(count_[0] * count_[1] * count_[2]);
    for (size_t z = 0; z < count_[2]; ++z)
      for (size_t y = 0; y < count_[1]; ++y)
        for (size_t x = 0; x < count_[0]; ++x) {
          values_.push_back(field(position({x, y, z})));
          const bool on_border = x == 0 || y == 0 || z == 0 || x + 1 == count_[0] ||
                                 y + 1 == count_[1] || z + 1 == count_[2];
          if (on_border && values_.back() < 0)
            throw std::invalid_argument("contoured: the solid reaches out of its box");
        }
  }

  using Index = std::array<size_t, 3>;
  Vec3d position(const Index& i) const {
    return low_ + Vec3d(double(i[0]), double(i[1]), double(i[2])) * cell_;
  }
  size_t at(const Index& i) const { return (i[2] * count_[1] + i[1]) * count_[0] + i[0]; }
  double value(const Index& i) const { return values_[at(i)]; }
  const Index& count() const { return count_; }
  size_t size() const { return values_.size(); }

 private:
  Vec3d low_;
  double cell_;
  Index count_;
  std::vector<double> values_;
};

using Index = Grid::Index;

Index corner_of(const Index& cell, int corner) {
  return {cell[0] + size_t(corner & 1), cell[1] + size_t(corner >> 1 & 1),
          cell[2] + size_t(corner >> 2)};
}

/// Mean of the crossings of the cell's edges; false where it has none.
bool mean_crossing(const Grid& grid, const Index& cell, Vec3d& mean) {
  Vec3d sum(0.0);
  int crossings = 0;
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      if (corner & 1 << axis) continue;
      const Index i = corner_of(cell, corner), j = corner_of(cell, corner | 1 << axis);
      const double a = grid.value(i), b = grid.value(j);
      if ((a < 0) == (b < 0)) continue;
      sum += grid.position(i) + (grid.position(j) - grid.position(i)) * (a / (a - b));
      ++crossings;
    }
  if (crossings == 0) return false;
  mean = sum / crossings;
  return true;
}

/// Newton's steps along the gradient, none longer than a third of a cell.
Vec3d moved_onto(const Field& field, Vec3d p, double cell) {
  for (int i = 0; i < 3; ++i) {
    const Vec3d g = gradient(field, p, 0.01 * cell);
    if (g.length2() < 1e-6) break;
    Vec3d step = g * (-field(p) / g.length2());
    if (step.length() > cell / 3) step *= cell / 3 / step.length();
    p += step;
  }
  return p;
}

/// The quad of the four cells around each crossed edge of the grid.
void add_quads(Mesh& mesh, const Grid& grid, const std::vector<uint32_t>& vertex_of) {
  const Index& n = grid.count();
  for (size_t z = 1; z + 1 < n[2]; ++z)
    for (size_t y = 1; y + 1 < n[1]; ++y)
      for (size_t x = 1; x + 1 < n[0]; ++x)
        for (size_t axis = 0; axis < 3; ++axis) {
          const Index i = {x, y, z};
          Index j = i;
          ++j[axis];
          const bool here = grid.value(i) < 0, there = grid.value(j) < 0;
          if (here == there) continue;
          const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          uint32_t around[4];
          for (size_t k = 0; k < 4; ++k) {
            Index cell = i;
            if (k == 0 || k == 3) --cell[u];
            if (k == 0 || k == 1) --cell[v];
            around[k] = vertex_of[grid.at(cell)];
          }
          if (here)
            mesh.quad(around[0], around[1], around[2], around[3]);
          else
            mesh.quad(around[0], around[3], around[2], around[1]);
        }
}

}  // namespace

Mesh contoured(const Field& field, const Vec3d& low, const Vec3d& high, double cell) {
  const Grid grid(field, low, high, cell);
  Mesh mesh;
  std::vector<uint32_t> vertex_of(grid.size(), 0);
  for (size_t z = 0; z + 1 < grid.count()[2]; ++z)
    for (size_t y = 0; y + 1 < grid.count()[1]; ++y)
      for (size_t x = 0; x + 1 < grid.count()[0]; ++x) {
        Vec3d p;
        if (!mean_crossing(grid, {x, y, z}, p)) continue;
        p = moved_onto(field, p, cell);
        const Vec2d uv((p.x - low.x) / (high.x - low.x), (p.z - low.z) / (high.z - low.z));
        vertex_of[grid.at({x, y, z})] = mesh.add(p, uv);
        mesh.vertices.back().normal = gradient(field, p, 0.05 * cell).normalized();
      }
  add_quads(mesh, grid, vertex_of);
  return mesh;
}

}  // namespace kaustik::scenes
