#pragma once
#include <array>
#include <optional>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Values at the nodes of a grid, trilinear between them, in a space where nodes stand at whole
/// numbers from 0. What a surface is to a signed distance field, where it is zero, is found exactly
/// along rays.
class GridField {
 public:
  /// `size`: nodes along x, y and z, at least 2 each; x runs fastest. Finite.
  GridField(const std::array<int, 3>& size, std::vector<float> values);

  Vec3d extent() const {
    return {double(size_[0] - 1), double(size_[1] - 1), double(size_[2] - 1)};
  }
  /// Whether it is zero anywhere.
  bool has_surface() const { return !cells_.empty(); }

  /// What follows is asked at points of the grid; others count as the nearest one there.
  double value(const Vec3d& p) const;
  /// Of the cell that holds the point; not normalised, zero where there is none.
  Vec3d gradient(const Vec3d& p) const;
  /// Between the central differences at the nodes: continuous everywhere.
  Vec3d smooth_gradient(const Vec3d& p) const;

  /// The first t in (0, t_max) where the value changes its sign along `from` + t `direction`: it
  /// has the one of its begin before. What the border of the grid cuts off is open.
  std::optional<double> crossing(const Vec3d& from, const Vec3d& direction, double t_max) const;

  /// At most `budget` boxes that hold the surface.
  std::vector<Imath::Box3d> surface_boxes(int budget) const;

 private:
  using Cell = std::array<int, 3>;
  /// The corners' values, bits x, y, z.
  using Corners = std::array<double, 8>;

  size_t node_index(int x, int y, int z) const {
    return (size_t(z) * size_t(size_[1]) + size_t(y)) * size_t(size_[0]) + size_t(x);
  }
  double node(int x, int y, int z) const { return double(values_[node_index(x, y, z)]); }
  Corners corners_of(const Cell& cell) const;
  /// The cell, and where in it.
  Cell cell_at(const Vec3d& p, Vec3d& within) const;
  Vec3d node_gradient(int x, int y, int z) const;
  bool may_cross(const Cell& cell) const;
  /// As crossing(), within a cell, for t from `begin` to `end`; `is_negative`: the sign before.
  std::optional<double> crossing_in(const Cell& cell, const Vec3d& from, const Vec3d& direction,
                                    double begin, double end, bool is_negative) const;

  std::array<int, 3> size_;
  std::vector<float> values_;
  /// Cells with values of both signs, or zero; and blocks of cells that hold some, as bits.
  std::vector<Cell> cells_;
  static constexpr int block_size = 8;
  std::array<int, 3> blocks_;
  std::vector<bool> block_is_used_;
  bool block_is_used(const Cell& block) const {
    return block_is_used_[(size_t(block[2]) * size_t(blocks_[1]) + size_t(block[1])) *
                              size_t(blocks_[0]) +
                          size_t(block[0])];
  }
};

}  // namespace kaustik
