// Passes of regions of a film.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

#include "kaustik/render/film.h"

namespace kaustik {
namespace {

static_assert(first_regional_pass == pass_limit);

/// Regions of a film, and their pixels over those of the picture: each keeps sums of its own.
constexpr size_t most_regions = 64;
constexpr int64_t most_region_shares = 4;

bool has_same_pixels(const FilmRegion& region, const PixelRegion& pixels) {
  return region.pixels == pixels;
}

auto find_region(const std::vector<FilmRegion>& regions, const PixelRegion& pixels) {
  return std::find_if(regions.begin(), regions.end(),
                      [&](const FilmRegion& region) { return has_same_pixels(region, pixels); });
}

/// The pixels of a tile, those beyond the picture included.
PixelRegion pixels_of_tile(const Vec2i& first) {
  return {first.x, first.y, PictureTiles::side, PictureTiles::side};
}

/// Calls body(x, y, length) for runs of pixels that lie in both, in the picture's coordinates, as
/// long as they lie in one tile of a region's own.
template <typename Body>
void for_runs(const PixelRegion& tile, const PixelRegion& region, const Body& body) {
  const int x0 = std::max(tile.x, region.x);
  const int x1 = std::min(tile.x + tile.width, region.x + region.width);
  const int y0 = std::max(tile.y, region.y);
  const int y1 = std::min(tile.y + tile.height, region.y + region.height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1;) {
      const int left = PictureTiles::side - (x - region.x) % PictureTiles::side;
      const int length = std::min(x1 - x, left);
      body(x, y, length);
      x += length;
    }
}

}  // namespace

std::string PixelRegion::text() const {
  return fmt::format("{} x {} pixels at ({}, {})", width, height, x, y);
}

std::string FilmRegion::text() const {
  return fmt::format("{}: {} passes", pixels.text(), film.pass_count());
}

std::string text_of(const std::vector<FilmRegion>& regions) {
  std::vector<std::string> texts;
  for (const FilmRegion& region : regions) texts.push_back(region.text());
  return fmt::format("{}", fmt::join(texts, "; "));
}

uint32_t Film::regional_pass_count() const {
  uint32_t count = 0;
  for (const FilmRegion& region : regions_) count += region.film.pass_count();
  return count;
}

uint32_t Film::next_regional_number() const {
  uint32_t next = 0;
  for (const FilmRegion& region : regions_) next = std::max(next, region.orders.back().passes.end);
  return next;
}

Pass Film::next_regional_pass(const PixelRegion& pixels, uint32_t stage) const {
  const uint32_t next = next_regional_number();
  if (next > pass_limit - replicate_count)
    throw Error(ErrorKind::input, "there are no more numbers for passes of regions",
                "render the picture again");
  const auto region = find_region(regions_, pixels);
  Pass pass;
  pass.order.stage = stage;
  if (region != regions_.end()) {
    const FilmOrder& last = region->orders.back();
    if (last.stage == stage && last.passes.end == next) {
      pass.index = first_regional_pass + next;
      pass.order.begin = first_regional_pass + last.passes.begin;
      return pass;
    }
  }
  const auto passes_of = [&](uint32_t number) {
    const uint32_t r = number % replicate_count;
    const uint32_t own =
        region == regions_.end() ? 0 : region->film.passes().count_of_remainder(r, replicate_count);
    return passes_.count_of_remainder(r, replicate_count) + own;
  };
  uint32_t best = next;
  for (uint32_t number = next; number < next + replicate_count; ++number)
    if (passes_of(number) < passes_of(best)) best = number;
  pass.index = pass.order.begin = first_regional_pass + best;
  return pass;
}

void check_region(const PixelRegion& pixels, const std::vector<PixelRegion>& others,
                  const Vec2i& size) {
  if (!pixels.lies_in(size))
    throw Error(ErrorKind::input,
                fmt::format("the region of {} does not lie in the picture, which is {} x {}",
                            pixels.text(), size.x, size.y),
                "give a region of at least one pixel, within the picture");
  int64_t sum = pixels.pixel_count();
  for (const PixelRegion& other : others) sum += other.pixel_count();
  if (others.size() < most_regions && sum <= most_region_shares * int64_t(size.x) * size.y) return;
  throw Error(
      ErrorKind::input,
      fmt::format("there are too many regions with passes of their own: {}, of {} pixels together",
                  others.size(), sum - pixels.pixel_count()),
      "ask for more passes of one of those that are there, or let all of the picture go on");
}

std::pair<std::vector<FilmRegion>::iterator, bool> Film::place_of(const PixelRegion& pixels) {
  const auto at =
      std::lower_bound(regions_.begin(), regions_.end(), pixels,
                       [](const FilmRegion& a, const PixelRegion& b) { return a.pixels < b; });
  return {at, at != regions_.end() && at->pixels == pixels};
}

void Film::add_regional_pass(const PixelRegion& pixels, const PassTiles& of_region,
                             const Pass& pass) {
  assert(pixels.lies_in(size_) && pass.is_regional());
  const uint32_t number = pass.index - first_regional_pass;
  const FilmOrder order{{number, number + 1}, pass.order.stage};
  const auto [at, is_there] = place_of(pixels);
  if (!is_there) {
    // A region is there only once it has a pass, whatever fails before.
    FilmRegion region{pixels, Film({pixels.width, pixels.height}, layers_), {order}};
    region.film.sums_.resize(region.film.tiles_.count());
    region.film.add_pass(of_region, number, pass.samples_per_pixel);
    regions_.insert(at, std::move(region));
    return;
  }
  at->film.add_pass(of_region, number, pass.samples_per_pixel);
  std::vector<FilmOrder>& orders = at->orders;
  if (orders.back().passes.end == number && orders.back().stage == order.stage)
    ++orders.back().passes.end;
  else
    orders.push_back(order);
}

void FilmRegion::add(const FilmRegion& other) {
  film.add(other.film);
  const auto middle = std::ptrdiff_t(orders.size());
  orders.insert(orders.end(), other.orders.begin(), other.orders.end());
  std::inplace_merge(
      orders.begin(), orders.begin() + middle, orders.end(),
      [](const FilmOrder& a, const FilmOrder& b) { return a.passes.begin < b.passes.begin; });
}

PassSet Film::twice_in_regions(const Film& other) const {
  PassSet twice;
  for (const FilmRegion& a : regions_)
    for (const FilmRegion& b : other.regions_)
      if (a.pixels.meets(b.pixels)) twice.add(a.film.passes().common(b.film.passes()));
  return twice;
}

uint32_t Film::pass_count(size_t pixel) const {
  const int x = int(pixel % size_t(size_.x)), y = int(pixel / size_t(size_.x));
  uint32_t count = passes_.count();
  for (const FilmRegion& region : regions_)
    if (region.pixels.holds(x, y)) count += region.film.pass_count();
  return count;
}

void Film::add_regions(size_t tile, std::vector<Fixed>& sums) const {
  const PixelRegion of_tile = pixels_of_tile(tiles_.first_pixel(tile));
  std::vector<Fixed> run;
  for (const FilmRegion& region : regions_) {
    const Film& film = region.film;
    for_runs(of_tile, region.pixels, [&](int x, int y, int length) {
      const int own_x = x - region.pixels.x, own_y = y - region.pixels.y;
      run.resize(size_t(length) * numbers_.count);
      film.sums_[film.tiles_.tile_at(own_x, own_y)].read_pixels(
          numbers_.count, PictureTiles::place_of(own_x, own_y), size_t(length), run.data());
      Fixed* to = sums.data() + PictureTiles::place_of(x, y) * numbers_.count;
      for (size_t i = 0; i < run.size(); ++i) add_to(to[i], run[i]);
    });
  }
}

void Film::read(size_t tile, std::vector<Fixed>& sums) const {
  sums.resize(PictureTiles::pixels * numbers_.count);
  sums_[tile].read_pixels(numbers_.count, 0, PictureTiles::pixels, sums.data());
  if (!regions_.empty()) add_regions(tile, sums);
}

void Film::read(size_t tile, size_t number, std::array<Fixed, PictureTiles::pixels>& sums) const {
  sums_[tile].read(number, numbers_.count, sums);
  if (regions_.empty()) return;
  const PixelRegion of_tile = pixels_of_tile(tiles_.first_pixel(tile));
  for (const FilmRegion& region : regions_) {
    const Film& film = region.film;
    std::array<Fixed, PictureTiles::pixels> line;
    size_t unpacked = film.tiles_.count();
    for_runs(of_tile, region.pixels, [&](int x, int y, int length) {
      const int own_x = x - region.pixels.x, own_y = y - region.pixels.y;
      const size_t own_tile = film.tiles_.tile_at(own_x, own_y);
      if (own_tile != unpacked) film.sums_[own_tile].read(number, numbers_.count, line);
      unpacked = own_tile;
      const size_t from = PictureTiles::place_of(own_x, own_y), to = PictureTiles::place_of(x, y);
      for (size_t i = 0; i < size_t(length); ++i) add_to(sums[to + i], line[from + i]);
    });
  }
}

Fixed Film::sum(size_t pixel, size_t number) const {
  const int x = int(pixel % size_t(size_.x)), y = int(pixel / size_t(size_.x));
  Fixed sum = sums_[tiles_.tile_at(x, y)].at(number, numbers_.count, PictureTiles::place_of(x, y));
  for (const FilmRegion& region : regions_)
    if (const PixelRegion& in = region.pixels; in.holds(x, y))
      add_to(sum, region.film.sum(size_t(y - in.y) * size_t(in.width) + size_t(x - in.x), number));
  return sum;
}

}  // namespace kaustik
