#include "kit/maze.h"

#include <gtest/gtest.h>

#include <set>

namespace kaustik::scenes {
namespace {

using Cell = std::pair<int, int>;

TEST(Maze, EveryTwoCellsAreJoinedByOneWay) {
  for (const int size : {2, 7, 20}) {
    const Maze maze(size, 5);
    std::set<Cell> reached = {{0, 0}};
    std::vector<Cell> front = {{0, 0}};
    size_t doors = 0;  // each counted from both sides
    while (!front.empty()) {
      const Cell cell = front.back();
      front.pop_back();
      for (const Cell& next : maze.ways_from(cell.first, cell.second)) {
        ++doors;
        if (reached.insert(next).second) front.push_back(next);
      }
    }
    const size_t cells = size_t(size) * size_t(size);
    EXPECT_EQ(reached.size(), cells);
    EXPECT_EQ(doors, 2 * (cells - 1));  // a tree: one door fewer than cells
  }
}

TEST(Maze, DependsOnItsSeedAlone) {
  const auto walls = [](const Maze& maze) {
    std::vector<bool> all;
    for (int y = 0; y < maze.size(); ++y)
      for (int x = 0; x < maze.size(); ++x) {
        all.push_back(maze.wall_east(x, y));
        all.push_back(maze.wall_north(x, y));
      }
    return all;
  };
  EXPECT_EQ(walls(Maze(12, 1)), walls(Maze(12, 1)));
  EXPECT_NE(walls(Maze(12, 1)), walls(Maze(12, 2)));
}

}  // namespace
}  // namespace kaustik::scenes
