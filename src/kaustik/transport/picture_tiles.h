#pragma once
#include <array>
#include <cstddef>

#include "kaustik/base/vec.h"

namespace kaustik {

/// A picture cut into squares of 16 × 16 pixels, row by row: what is rendered, splatted and summed
/// is kept square by square. Those at the right and lower edges may reach beyond the picture.
class PictureTiles {
 public:
  static constexpr int side = 16;
  static constexpr size_t pixels = size_t{side} * side;  ///< of each, those beyond included

  explicit PictureTiles(const Vec2i& size) : size_(size), across_((size.x + side - 1) / side) {}

  size_t count() const { return size_t(across_) * size_t((size_.y + side - 1) / side); }
  size_t tile_at(int x, int y) const {
    return size_t(y / side) * size_t(across_) + size_t(x / side);
  }
  /// Within its tile, row by row.
  static size_t place_of(int x, int y) { return size_t(y % side) * side + size_t(x % side); }

  /// Its upper left one.
  Vec2i first_pixel(size_t tile) const {
    return {int(tile % size_t(across_)) * side, int(tile / size_t(across_)) * side};
  }

  /// Calls body(x, y, place) for all pixels of the picture that lie in the tile, row by row.
  template <typename Body>
  void for_pixels_of(size_t tile, const Body& body) const {
    const int x0 = first_pixel(tile).x, y0 = first_pixel(tile).y;
    for (int y = y0; y < size_.y && y < y0 + side; ++y)
      for (int x = x0; x < size_.x && x < x0 + side; ++x) body(x, y, place_of(x, y));
  }

 private:
  Vec2i size_;
  int across_;
};

}  // namespace kaustik
