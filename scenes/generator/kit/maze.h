#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kaustik::scenes {

/// A maze of size x size cells in which every two cells are joined by exactly one way, made by
/// walking at random and turning back where all neighbours are known (depth-first search).
class Maze {
 public:
  Maze(int size, uint64_t seed);

  int size() const { return size_; }
  /// Whether a wall stands on the east side of a cell, or on its north side; the outermost ones
  /// always do.
  bool wall_east(int x, int y) const { return x + 1 == size_ || walls_east_[index(x, y)]; }
  bool wall_north(int x, int y) const { return y + 1 == size_ || walls_north_[index(x, y)]; }
  /// The cells that can be entered from a cell.
  std::vector<std::pair<int, int>> ways_from(int x, int y) const;

 private:
  size_t index(int x, int y) const { return size_t(y) * size_t(size_) + size_t(x); }
  void open(int x0, int y0, int x1, int y1);

  int size_;
  std::vector<bool> walls_east_, walls_north_;
};

}  // namespace kaustik::scenes
