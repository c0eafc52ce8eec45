#pragma once
#include "kaustik/scene/film_settings.h"

namespace kaustik {

/// The part of the whole picture that plans are made for: the crop window and as much around it as
/// what is learned of its border is averaged with. It begins where a block of the whole picture
/// does: where blocks are of one size in both, a part is planned as the whole picture is.
struct PlanWindow {
  Vec2i size{1, 1};    ///< pixels
  Vec2i before{0, 0};  ///< pixels of it left of the crop window and above it
  Vec2i crop{1, 1};    ///< size of the crop window

  /// On a side: one block of the trial of connections has so many of the plans.
  static constexpr int blocks_per_trial = 2;

  PlanWindow() = default;
  /// Disks are smoothed over the blocks beside theirs, of which each was chosen by those beside it.
  static constexpr int blocks_around = 2;
  /// Of blocks of so many pixels on a side, and so many of them around the crop window.
  PlanWindow(const FilmSettings& film, int block_size, int margin_blocks = blocks_around);

  Vec2i blocks(int block_size) const { return (size + Vec2i(block_size - 1)) / block_size; }
  /// How many pixels of the block in that column and row are in the crop window.
  int crop_pixels(const Vec2i& block, int block_size) const;
  /// From its own raster to that of the crop window.
  Vec2f in_crop(const Vec2f& raster) const {
    return raster - Vec2f(float(before.x), float(before.y));
  }
};

}  // namespace kaustik
