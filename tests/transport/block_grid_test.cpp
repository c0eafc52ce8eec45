#include "kaustik/transport/block_grid.h"

#include <gtest/gtest.h>

#include <set>

namespace kaustik {
namespace {

BlockGrid grid_of(Vec2i size, int block_size) {
  PlanWindow window;
  window.size = window.crop = size;
  return {window, block_size};
}

TEST(BlockGrid, NumbersBlocksRowByRow) {
  const BlockGrid grid = grid_of({10, 7}, 4);
  EXPECT_EQ(grid.count(), Vec2i(3, 2));
  EXPECT_EQ(grid.size(), 6u);
  for (size_t i = 0; i < grid.size(); ++i) {
    EXPECT_EQ(grid.index_of(grid.block(i)), i);
    EXPECT_EQ(grid.first_pixel(i), grid.block(i) * 4);
    EXPECT_EQ(grid.index_at(grid.middle(i)), i);
  }
  EXPECT_EQ(grid.block(4), Vec2i(1, 1));
}

TEST(BlockGrid, MiddlesLieInTheWindow) {
  const BlockGrid grid = grid_of({10, 7}, 4);
  EXPECT_EQ(grid.middle(0), Vec2f(2, 2));
  EXPECT_EQ(grid.middle(5), Vec2f(9.5f, 6));  // the block's own middle would be (10, 6)
}

TEST(BlockGrid, PointsBeyondBelongToTheNearestBlock) {
  const BlockGrid grid = grid_of({10, 7}, 4);
  EXPECT_EQ(grid.block_at({-3, 2}), Vec2i(0, 0));
  EXPECT_EQ(grid.block_at({100, 100}), Vec2i(2, 1));
}

TEST(BlockGrid, PixelsOfTheCropWindow) {
  PlanWindow window;
  window.size = {12, 8};
  window.before = {3, 2};
  window.crop = {5, 4};
  const BlockGrid grid(window, 4);
  EXPECT_EQ(grid.crop_pixels(0), 1 * 2);
  EXPECT_EQ(grid.crop_pixels(1), 4 * 2);
  EXPECT_EQ(grid.crop_pixels(2), 0);
  EXPECT_EQ(grid.crop_pixels(4), 4 * 2);
  EXPECT_EQ(grid.index_at({0, 0}), 0u);
  EXPECT_EQ(grid.index_at({1, 2}), 4u);
}

TEST(BlockGrid, VisitsBlocksThatTouch) {
  const BlockGrid grid = grid_of({20, 12}, 4);
  const auto around = [&](Vec2i block) {
    std::set<size_t> found;
    size_t visits = 0;
    grid.visit_around(grid.index_of(block), [&](size_t i) {
      found.insert(i);
      ++visits;
      const Vec2i away = grid.block(i) - block;
      EXPECT_LE(std::max(std::abs(away.x), std::abs(away.y)), 1);
    });
    EXPECT_EQ(found.size(), visits);
    return visits;
  };
  EXPECT_EQ(around({2, 1}), 9u);
  EXPECT_EQ(around({0, 1}), 6u);
  EXPECT_EQ(around({4, 2}), 4u);
}

}  // namespace
}  // namespace kaustik
