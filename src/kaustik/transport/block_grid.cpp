#include "kaustik/transport/block_grid.h"

namespace kaustik {

PlanWindow::PlanWindow(const FilmSettings& film, int block_size, int margin_blocks)
    : crop(film.crop_size) {
  const int together = blocks_together * block_size;
  const auto along = [&](int offset, int length, int whole, int& own_size, int& own_before) {
    const int margin = margin_blocks * block_size;
    const int begin = std::max(0, offset - margin) / together * together;
    const int last_block = (offset + length - 1) / block_size + margin_blocks;
    own_before = offset - begin;
    own_size = std::min(whole, (last_block + 1) * block_size) - begin;
  };
  along(film.crop_offset.x, film.crop_size.x, film.size.x, size.x, before.x);
  along(film.crop_offset.y, film.crop_size.y, film.size.y, size.y, before.y);
}

Vec2f BlockGrid::middle(size_t index) const {
  const Vec2i at = block(index);
  const auto along = [&](int number, int length) {
    return std::min((float(number) + 0.5f) * float(block_size_), float(length) - 0.5f);
  };
  return {along(at.x, window_.size.x), along(at.y, window_.size.y)};
}

int BlockGrid::crop_pixels(size_t index) const {
  const auto along = [&](int number, int before, int length) {
    const int begin = number * block_size_ - before;
    return std::max(0, std::min(begin + block_size_, length) - std::max(begin, 0));
  };
  const Vec2i at = block(index);
  return along(at.x, window_.before.x, window_.crop.x) *
         along(at.y, window_.before.y, window_.crop.y);
}

}  // namespace kaustik
