// A film's sums on their way between processes.
#include <algorithm>
#include <cassert>

#include "kaustik/base/parallel.h"
#include "kaustik/render/film.h"

namespace kaustik {
namespace {

/// That one thread packs, one after the other, with the same buffers.
constexpr size_t tiles_per_task = 8;

}  // namespace

void Film::read_tiles(size_t first, std::span<Fixed> sums) const {
  const size_t of_tile = sums_per_tile();
  assert(sums.size() % of_tile == 0 && first + sums.size() / of_tile <= tiles_.count());
  parallel_blocks(sums.size() / of_tile, tiles_per_task, [&](size_t begin, size_t end, size_t) {
    std::array<Fixed, PictureTiles::pixels> line;
    for (size_t tile = begin; tile < end; ++tile)
      for (size_t number = 0; number < numbers_.count; ++number) {
        sums_[first + tile].read(number, numbers_.count, line);
        std::ranges::copy(line,
                          sums.begin() + std::ptrdiff_t(tile * of_tile + number * line.size()));
      }
  });
}

void Film::add_tiles(size_t first, std::span<const Fixed> sums) {
  const size_t of_tile = sums_per_tile();
  assert(sums.size() % of_tile == 0 && first + sums.size() / of_tile <= tiles_.count());
  parallel_blocks(sums.size() / of_tile, tiles_per_task, [&](size_t begin, size_t end, size_t) {
    TilePacker packer(numbers_.count);
    std::array<Fixed, PictureTiles::pixels> line;
    for (size_t tile = begin; tile < end; ++tile) {
      packer.begin(sums_[first + tile]);
      for (size_t number = 0; number < numbers_.count; ++number) {
        const auto from = sums.subspan(tile * of_tile + number * line.size(), line.size());
        std::ranges::copy(from, line.begin());
        if (std::ranges::all_of(line, [](Fixed sum) { return sum == 0; }))
          packer.keep();
        else
          packer.add(line);
      }
      packer.end(sums_[first + tile]);
    }
  });
}

void Film::add_facts(const FilmFacts& facts) {
  assert(passes_.common(facts.passes).empty());
  passes_.add(facts.passes);
  sample_count_ += facts.samples_per_pixel;
  for (size_t r = 0; r < replicate_count; ++r)
    add_to(mean_luminances_[r], facts.mean_luminances[r]);
}

void Film::clear() {
  passes_ = {};
  sample_count_ = 0;
  mean_luminances_ = {};
  regions_.clear();
  for (PackedTile& tile : sums_) tile = {};
}

}  // namespace kaustik
