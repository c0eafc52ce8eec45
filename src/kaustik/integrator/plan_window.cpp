#include "kaustik/integrator/plan_window.h"

#include <algorithm>

namespace kaustik {

PlanWindow::PlanWindow(const FilmSettings& film, int block_size, int margin_blocks)
    : crop(film.crop_size) {
  const int together = blocks_per_trial * block_size;
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

int PlanWindow::crop_pixels(const Vec2i& block, int block_size) const {
  const auto along = [&](int number, int own_before, int length) {
    const int begin = number * block_size - own_before;
    return std::max(0, std::min(begin + block_size, length) - std::max(begin, 0));
  };
  return along(block.x, before.x, crop.x) * along(block.y, before.y, crop.y);
}

}  // namespace kaustik
