#include "kaustik/loader/nanovdb_tree.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace kaustik {
namespace {

using Voxel = std::array<int64_t, 3>;

// Bytes of the parts of a grid of floats, and where numbers lie in them.
constexpr uint64_t grid_bytes = 672;
constexpr uint64_t map_matrix = 296 + 88, map_offset = 296 + 232, grid_type = 636;
constexpr uint64_t root_offset_of_tree = 24;
constexpr uint64_t root_bytes = 64, root_table_size = 24, tile_bytes = 32;
constexpr uint32_t type_float = 1;

/// A node above the leaves.
struct Level {
  uint64_t bytes, child_mask, table;
  int log2_children;  ///< along an axis
  int log2_child;     ///< voxels of a child along an axis
};
constexpr Level upper{270400, 4128, 8256, 5, 7}, lower{33856, 544, 1088, 4, 3};
constexpr uint64_t leaf_bytes = 2144, leaf_values = 96;
constexpr int log2_root_child = 12, leaf_side = 8;

int64_t divided_up(int64_t a, int64_t b) { return (a + b - 1) / b; }

/// Sums up what a tree holds.
class Walk {
 public:
  Walk(const NanoVdbBytes& grid, size_t most_samples) : grid_(grid) {
    if (grid.at<uint32_t>(grid_type) != type_float)
      grid.refuse("the grid is not one of floats", "write it as floats");
    root_ = grid_bytes + grid.at<uint64_t>(grid_bytes + root_offset_of_tree);
    for (size_t i = 0; i < 3; ++i) {
      const int64_t low = grid.at<int32_t>(root_ + 4 * i);
      const int64_t high = grid.at<int32_t>(root_ + 12 + 4 * i);
      if (low > high) grid.refuse("the grid is empty", "name another");
      low_[i] = low - margin;
      extent_[i] = high - low + 1 + 2 * margin;
    }
    choose_step(most_samples);
  }

  DenseGrid result() {
    walk_root();
    DenseGrid dense;
    for (size_t i = 0; i < 3; ++i) dense.size[i] = size_t(size_[i]);
    const auto share = float(1 / (double(step_) * double(step_) * double(step_)));
    for (float& sample : samples_) sample *= share;
    dense.samples = std::move(samples_);
    dense.voxels_per_sample = int(step_);
    dense.to_world = world_from_unit();
    return dense;
  }

 private:
  static constexpr int64_t margin = 1;

  void choose_step(size_t most_samples) {
    const auto count = [&] {
      double product = 1;
      for (size_t i = 0; i < 3; ++i) product *= double(divided_up(extent_[i], step_));
      return product;
    };
    while (count() > double(most_samples)) ++step_;
    for (size_t i = 0; i < 3; ++i) size_[i] = divided_up(extent_[i], step_);
    samples_.resize(size_t(size_[0]) * size_t(size_[1]) * size_t(size_[2]));
    voxels_left_ = double(extent_[0]) * double(extent_[1]) * double(extent_[2]);
  }

  /// Centres of voxels lie at whole numbers.
  Transform world_from_unit() const {
    double rows[4][4] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}};
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) rows[i][j] = grid_.at<double>(map_matrix + 8 * (3 * i + j));
      rows[i][3] = grid_.at<double>(map_offset + 8 * i);
    }
    const Vec3d low =
        Vec3d{double(low_[0]), double(low_[1]), double(low_[2])} - Vec3d(0.5, 0.5, 0.5);
    const auto length = [&](size_t i) { return double(size_[i] * step_); };
    try {
      return Transform(rows) * Transform::translate(low) *
             Transform::scale({length(0), length(1), length(2)});
    } catch (const std::invalid_argument&) {
      grid_.damaged("its place in the world is no affine map");
    }
  }

  /// No node is used twice, so that the work is in proportion to the file.
  void spend(uint64_t bytes) {
    spent_ += bytes;
    if (spent_ > grid_.size()) grid_.damaged("parts of it are used twice");
  }

  void walk_root() {
    const auto count = grid_.at<uint32_t>(root_ + root_table_size);
    spend(root_bytes + tile_bytes * uint64_t(count));
    for (uint32_t i = 0; i < count; ++i) {
      const uint64_t tile = root_ + root_bytes + tile_bytes * uint64_t(i);
      const auto key = grid_.at<uint64_t>(tile);
      const auto child = grid_.at<uint64_t>(tile + 8);
      Voxel first{};
      for (size_t axis = 0; axis < 3; ++axis) {
        const uint64_t bits = (key >> (21 * (2 - axis))) & ((uint64_t{1} << 21) - 1);
        first[axis] = int32_t(uint32_t(bits << log2_root_child));
      }
      if (child != 0)
        walk_node(root_ + child, first, upper);
      else
        fill(first, int64_t{1} << log2_root_child, grid_.at<float>(tile + 20));
    }
  }

  void walk_node(uint64_t node, const Voxel& first, const Level& level) {
    spend(level.bytes);
    const auto bytes = grid_.part(node, level.bytes);
    const int bits = level.log2_children;
    const int64_t child_side = int64_t{1} << level.log2_child, mask = (int64_t{1} << bits) - 1;
    for (int64_t i = 0; i < int64_t{1} << (3 * bits); ++i) {
      const Voxel begin{first[0] + (i >> (2 * bits)) * child_side,
                        first[1] + ((i >> bits) & mask) * child_side,
                        first[2] + (i & mask) * child_side};
      const bool is_child = (bytes[size_t(level.child_mask) + size_t(i >> 3)] >> (i & 7)) & 1;
      const uint64_t entry = node + level.table + 8 * uint64_t(i);
      if (!is_child)
        fill(begin, child_side, grid_.at<float>(entry));
      else if (level.log2_child == lower.log2_child)
        add_leaf(node + grid_.at<uint64_t>(entry), begin);
      else
        walk_node(node + grid_.at<uint64_t>(entry), begin, lower);
    }
  }

  void check(float value) const {
    if (!std::isfinite(value)) grid_.damaged("a number of it is not finite");
  }

  float& sample(int64_t x, int64_t y, int64_t z) {
    return samples_[size_t(x + size_[0] * (y + size_[1] * z))];
  }

  void add_leaf(uint64_t leaf, const Voxel& first) {
    spend(leaf_bytes);
    const auto values = grid_.part(leaf, leaf_bytes).subspan(leaf_values);
    for (int64_t i = 0; i < leaf_side * leaf_side * leaf_side; ++i) {
      float value;
      std::memcpy(&value, values.data() + 4 * i, sizeof value);
      check(value);
      const int64_t x = first[0] + (i >> 6) - low_[0], y = first[1] + ((i >> 3) & 7) - low_[1],
                    z = first[2] + (i & 7) - low_[2];
      if (x < 0 || y < 0 || z < 0 || x >= extent_[0] || y >= extent_[1] || z >= extent_[2])
        continue;
      sample(x / step_, y / step_, z / step_) += value;
    }
  }

  /// A cube of one value.
  void fill(const Voxel& first, int64_t side, float value) {
    check(value);
    if (value == 0) return;
    Voxel begin{}, end{};
    double voxels = 1;
    for (size_t i = 0; i < 3; ++i) {
      begin[i] = std::max<int64_t>(first[i] - low_[i], 0);
      end[i] = std::min(first[i] + side - low_[i], extent_[i]);
      if (begin[i] >= end[i]) return;
      voxels *= double(end[i] - begin[i]);
    }
    voxels_left_ -= voxels;
    if (voxels_left_ < 0) grid_.damaged("parts of it overlap");
    const auto covered = [&](size_t axis, int64_t cell) {
      return double(std::min(end[axis], (cell + 1) * step_) - std::max(begin[axis], cell * step_));
    };
    for (int64_t z = begin[2] / step_; z * step_ < end[2]; ++z)
      for (int64_t y = begin[1] / step_; y * step_ < end[1]; ++y)
        for (int64_t x = begin[0] / step_; x * step_ < end[0]; ++x)
          sample(x, y, z) += float(double(value) * covered(0, x) * covered(1, y) * covered(2, z));
  }

  const NanoVdbBytes& grid_;
  uint64_t root_ = 0, spent_ = 0;
  Voxel low_{}, extent_{}, size_{};  ///< of the box with its margin, in voxels; of the samples
  int64_t step_ = 1;
  double voxels_left_ = 0;  ///< that cubes of one value may still cover
  std::vector<float> samples_;
};

}  // namespace

DenseGrid dense_grid_of(const NanoVdbBytes& grid, size_t most_samples) {
  return Walk(grid, std::max<size_t>(most_samples, 1)).result();
}

}  // namespace kaustik
