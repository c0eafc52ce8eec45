#include "kit/maze.h"

#include <algorithm>

#include "kit/random.h"

namespace kaustik::scenes {

Maze::Maze(int size, uint64_t seed)
    : size_(size),
      walls_east_(size_t(size) * size_t(size), true),
      walls_north_(walls_east_.size(), true) {
  Random random(seed);
  std::vector<bool> known(walls_east_.size(), false);
  std::vector<std::pair<int, int>> way = {{0, 0}};
  known[0] = true;
  while (!way.empty()) {
    const auto [x, y] = way.back();
    std::vector<std::pair<int, int>> next;
    for (const auto& [dx, dy] :
         {std::pair(1, 0), std::pair(0, 1), std::pair(-1, 0), std::pair(0, -1)}) {
      const int u = x + dx, v = y + dy;
      if (u >= 0 && v >= 0 && u < size && v < size && !known[index(u, v)]) next.emplace_back(u, v);
    }
    if (next.empty()) {
      way.pop_back();
      continue;
    }
    const auto [u, v] = next[random.index(next.size())];
    open(x, y, u, v);
    known[index(u, v)] = true;
    way.emplace_back(u, v);
  }
}

void Maze::open(int x0, int y0, int x1, int y1) {
  if (y0 == y1)
    walls_east_[index(std::min(x0, x1), y0)] = false;
  else
    walls_north_[index(x0, std::min(y0, y1))] = false;
}

std::vector<std::pair<int, int>> Maze::ways_from(int x, int y) const {
  std::vector<std::pair<int, int>> ways;
  if (!wall_east(x, y)) ways.emplace_back(x + 1, y);
  if (!wall_north(x, y)) ways.emplace_back(x, y + 1);
  if (x > 0 && !wall_east(x - 1, y)) ways.emplace_back(x - 1, y);
  if (y > 0 && !wall_north(x, y - 1)) ways.emplace_back(x, y - 1);
  return ways;
}

}  // namespace kaustik::scenes
