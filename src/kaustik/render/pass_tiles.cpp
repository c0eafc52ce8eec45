#include "kaustik/render/pass_tiles.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

constexpr size_t count = PictureTiles::pixels;
using Bits = std::array<uint32_t, count>;

Vec3f rgb_of(const Spectrum& radiance) { return {radiance[0], radiance[1], radiance[2]}; }

/// Calls body(line, number) for the numbers of a pixel, in the order of lines.
template <typename Body>
void for_numbers_of(const PassPixel& pixel, const Body& body) {
  size_t line = 0;
  const auto put = [&](const Spectrum& s) {
    for (int lane = 0; lane < 3; ++lane) body(line++, s[lane]);
  };
  for (const Spectrum& radiance : pixel.radiance) put(radiance);
  put(pixel.first_hit.albedo);
  for (int axis = 0; axis < 3; ++axis) body(line++, pixel.first_hit.normal[axis]);
  body(line++, pixel.first_hit.depth);
  body(line++, pixel.first_hit.lamps);
  for (const float square : pixel.squares) body(line++, square);
  put(pixel.bias);
}

/// Sets them, where number_of(line) is asked in the same order.
template <typename NumberOf>
void set_numbers_of(PassPixel& pixel, const NumberOf& number_of) {
  size_t line = 0;
  const auto get = [&](Spectrum& s) {
    for (int lane = 0; lane < 3; ++lane) s.set(lane, number_of(line++));
  };
  for (Spectrum& radiance : pixel.radiance) get(radiance);
  get(pixel.first_hit.albedo);
  for (int axis = 0; axis < 3; ++axis) pixel.first_hit.normal[axis] = number_of(line++);
  pixel.first_hit.depth = number_of(line++);
  pixel.first_hit.lamps = number_of(line++);
  for (float& square : pixel.squares) square = number_of(line++);
  get(pixel.bias);
}

}  // namespace

std::array<float, noise_kinds> by_noise_kind(
    const std::array<Spectrum, component_count>& radiance) {
  const auto part = [&](Component c) { return radiance[size_t(c)]; };
  return {photopic(rgb_of(part(Component::direct) + part(Component::caustic) +
                          part(Component::indirect))),
          photopic(rgb_of(part(Component::specular)))};
}

size_t PassTiles::size_of(Kind kind) {
  return kind == Kind::full ? count : kind == Kind::uniform ? 1 : 0;
}

void PassTiles::store(size_t tile, const Pixels& pixels) {
  const auto lines = std::make_unique<std::array<Bits, line_count + 1>>();
  for (size_t i = 0; i < count; ++i) {
    for_numbers_of(pixels[i], [&](size_t line, float number) {
      (*lines)[line][i] = std::bit_cast<uint32_t>(number);
    });
    lines->back()[i] = pixels[i].samples;
  }
  StoredTile& stored = stored_[tile];
  size_t size = 0;
  for (size_t line = 0; line <= line_count; ++line) {
    const Bits& bits = (*lines)[line];
    const bool is_uniform = std::equal(bits.begin() + 1, bits.end(), bits.begin());
    stored.kinds[line] = !is_uniform ? Kind::full : bits[0] != 0 ? Kind::uniform : Kind::zero;
    size += size_of(stored.kinds[line]);
  }
  if (stored.numbers.size() != size) stored.numbers = std::vector<float>(size);
  float* to = stored.numbers.data();
  for (size_t line = 0; line <= line_count; ++line) {
    const size_t numbers = size_of(stored.kinds[line]);
    if (numbers > 0) std::memcpy(to, (*lines)[line].data(), numbers * sizeof(float));
    to += numbers;
  }
}

const PassTiles::Line* PassTiles::read(size_t tile, size_t line, Line& uniform) const {
  const StoredTile& stored = stored_[tile];
  if (stored.kinds[line] == Kind::zero) return nullptr;
  const float* first = stored.numbers.data();
  for (size_t i = 0; i < line; ++i) first += size_of(stored.kinds[i]);
  // An array is nothing but its elements.
  if (stored.kinds[line] == Kind::full) return reinterpret_cast<const Line*>(first);
  uniform.fill(*first);
  return &uniform;
}

void PassTiles::read_samples(size_t tile, Bits& samples) const {
  Line uniform;
  if (const Line* bits = read(tile, line_count, uniform))
    std::memcpy(samples.data(), bits->data(), sizeof samples);
  else
    samples.fill(0);
}

void PassTiles::load(size_t tile, Pixels& pixels) const {
  if (stored_[tile].numbers.empty()) return pixels.fill({});
  static constexpr Line zeros{};
  std::array<Line, line_count> uniform;
  std::array<const Line*, line_count> lines;
  for (size_t line = 0; line < line_count; ++line) {
    lines[line] = read(tile, line, uniform[line]);
    if (!lines[line]) lines[line] = &zeros;
  }
  Bits samples;
  read_samples(tile, samples);
  for (size_t i = 0; i < count; ++i) {
    set_numbers_of(pixels[i], [&](size_t line) { return (*lines[line])[i]; });
    pixels[i].samples = samples[i];
  }
}

PassTiles PassTiles::cut_out(const PixelRegion& region) const {
  PassTiles part({region.width, region.height});
  parallel_blocks(part.tiles_.count(), 1, [&](size_t tile, size_t, size_t) {
    constexpr int side = PictureTiles::side;
    const auto from = std::make_unique<Pixels>(), to = std::make_unique<Pixels>();
    const Vec2i first = part.tiles_.first_pixel(tile) + Vec2i(region.x, region.y);
    // A tile of the part lies in up to four of these, each of which is loaded once.
    for (int down = 0; down < 2; ++down)
      for (int across = 0; across < 2; ++across) {
        size_t source = tiles_.count();
        part.tiles_.for_pixels_of(tile, [&](int x, int y, size_t place) {
          const int whole_x = x + region.x, whole_y = y + region.y;
          if (whole_x / side - first.x / side != across || whole_y / side - first.y / side != down)
            return;
          const size_t of_pixel = tiles_.tile_at(whole_x, whole_y);
          if (of_pixel != source) load(of_pixel, *from);
          source = of_pixel;
          (*to)[place] = (*from)[PictureTiles::place_of(whole_x, whole_y)];
        });
      }
    part.store(tile, *to);
  });
  return part;
}

uint32_t PassTiles::fewest_samples() const {
  uint32_t fewest = std::numeric_limits<uint32_t>::max();
  Bits samples;
  for (size_t tile = 0; tile < tiles_.count(); ++tile) {
    read_samples(tile, samples);
    tiles_.for_pixels_of(
        tile, [&](int, int, size_t place) { fewest = std::min(fewest, samples[place]); });
  }
  return fewest;
}

void PassTiles::clear() {
  for (StoredTile& stored : stored_) stored = {};
}

size_t PassTiles::bytes() const {
  size_t sum = stored_.capacity() * sizeof(StoredTile);
  for (const StoredTile& stored : stored_) sum += stored.numbers.capacity() * sizeof(float);
  return sum;
}

}  // namespace kaustik
