#pragma once
#include <algorithm>

#include "kaustik/scene/film_settings.h"

namespace kaustik {

/// The part of the whole picture that plans are made for: the crop window and as much around it as
/// what is learned of its border is averaged with. It begins where a block of the whole picture
/// does: where blocks are of one size in both, a part is planned as the whole picture is.
struct PlanWindow {
  Vec2i size{1, 1};    ///< pixels
  Vec2i before{0, 0};  ///< pixels of it left of the crop window and above it
  Vec2i crop{1, 1};    ///< size of the crop window

  /// The window begins at a multiple of so many blocks.
  static constexpr int blocks_together = 2;

  PlanWindow() = default;
  /// Disks are smoothed over the blocks beside theirs, of which each was chosen by those beside it.
  static constexpr int blocks_around = 2;
  /// Of blocks of so many pixels on a side, and so many of them around the crop window.
  PlanWindow(const FilmSettings& film, int block_size, int margin_blocks = blocks_around);

  /// From its own raster to that of the crop window.
  Vec2f in_crop(const Vec2f& raster) const {
    return raster - Vec2f(float(before.x), float(before.y));
  }
};

/// A window that is cut into square blocks of pixels, which are numbered row by row. The last block
/// of a row or column may lie in part beyond the window.
class BlockGrid {
 public:
  /// One block of one pixel.
  BlockGrid() = default;
  BlockGrid(const PlanWindow& window, int block_size)
      : window_(window),
        block_size_(block_size),
        count_((window.size + Vec2i(block_size - 1)) / block_size) {}

  const PlanWindow& window() const { return window_; }
  /// Pixels on a side.
  int block_size() const { return block_size_; }
  /// Blocks in a row, and rows.
  const Vec2i& count() const { return count_; }
  size_t size() const { return size_t(count_.x) * size_t(count_.y); }

  size_t index_of(const Vec2i& block) const {
    return size_t(block.y) * size_t(count_.x) + size_t(block.x);
  }
  /// Column and row.
  Vec2i block(size_t index) const {
    return {int(index % size_t(count_.x)), int(index / size_t(count_.x))};
  }
  /// The block with a point of the crop window's raster; for points beyond, the nearest one.
  size_t index_at(const Vec2f& raster) const { return index_of(block_at(raster)); }
  Vec2i block_at(const Vec2f& raster) const {
    const Vec2f at = raster + Vec2f(float(window_.before.x), float(window_.before.y));
    return {std::clamp(int(at.x) / block_size_, 0, count_.x - 1),
            std::clamp(int(at.y) / block_size_, 0, count_.y - 1)};
  }
  /// Upper left pixel of a block, in the window.
  Vec2i first_pixel(size_t index) const { return block(index) * block_size_; }
  /// The middle of a block in the window's own raster, or the nearest middle of a pixel of the
  /// window.
  Vec2f middle(size_t index) const;
  /// How many pixels of a block are in the crop window.
  int crop_pixels(size_t index) const;

  /// visit(index) for the block and those that touch it, row by row.
  template <typename Visit>
  void visit_around(size_t index, const Visit& visit) const {
    const Vec2i at = block(index);
    for (int y = std::max(0, at.y - 1); y <= std::min(count_.y - 1, at.y + 1); ++y)
      for (int x = std::max(0, at.x - 1); x <= std::min(count_.x - 1, at.x + 1); ++x)
        visit(index_of({x, y}));
  }

 private:
  PlanWindow window_;
  int block_size_ = 1;
  Vec2i count_{1, 1};
};

}  // namespace kaustik
