#pragma once
#include <vector>

#include "kaustik/render/pass_tiles.h"

namespace kaustik::test {

/// A pass of these pixels, row by row.
inline PassTiles pass_of(const std::vector<PassPixel>& pixels, const Vec2i& size) {
  PassTiles pass(size);
  for (size_t tile = 0; tile < pass.tiles().count(); ++tile) {
    const auto of_tile = std::make_unique<PassTiles::Pixels>();
    pass.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
      (*of_tile)[place] = pixels[size_t(y) * size_t(size.x) + size_t(x)];
    });
    pass.store(tile, *of_tile);
  }
  return pass;
}

}  // namespace kaustik::test
