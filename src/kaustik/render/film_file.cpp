// A film as part of a checkpoint: docs/reference/checkpoint_file.md.
#include <algorithm>
#include <atomic>

#include "kaustik/base/binary_file.h"
#include "kaustik/base/parallel.h"
#include "kaustik/render/film.h"
#include "kaustik/render/packed_sums.h"

namespace kaustik {
namespace {

/// That are packed or added side by side, and that one thread does, one after the other, with the
/// same buffers.
constexpr size_t tiles_at_a_time = 32, tiles_per_thread = 8;

/// Bytes of a file with some that may be read behind them.
class PaddedBytes {
 public:
  explicit PaddedBytes(size_t behind) : behind_(behind) {}
  /// The next ones of the file, which are still to be skipped. Until the reader is asked again.
  const uint8_t* of(BinaryReader& reader, uint64_t count) {
    reader.need(count, 1);
    const auto bytes = reader.bytes_ahead(count + behind_);
    if (bytes.size() >= count + behind_) return bytes.data();
    copy_.assign(bytes.begin(), bytes.begin() + std::ptrdiff_t(count));
    copy_.resize(count + behind_);
    return copy_.data();
  }

 private:
  size_t behind_;
  std::vector<uint8_t> copy_;
};

void put_passes(BinaryWriter& writer, const PassSet& passes) {
  writer.put(uint64_t(passes.ranges().size()));
  for (const PassRange& range : passes.ranges()) {
    writer.put(range.begin);
    writer.put(range.end);
  }
}

PassSet get_passes(BinaryReader& reader) {
  PassSet passes;
  const uint64_t count = reader.get_count(sizeof(PassRange));
  uint32_t last_end = 0;
  for (uint64_t i = 0; i < count; ++i) {
    const auto begin = reader.get<uint32_t>(), end = reader.get<uint32_t>();
    if (begin >= end || end > pass_limit || (i > 0 && begin <= last_end))
      reader.damaged("its passes are not valid");
    passes.add({begin, end});
    last_end = end;
  }
  return passes;
}

/// Beside the components' bits; absent in files that were written before there was a choice.
constexpr uint32_t without_layers = uint32_t(1) << 31, with_pixels_apart = uint32_t(1) << 30,
                   with_regions = uint32_t(1) << 29, with_halves = uint32_t(1) << 28;

void put_layers(BinaryWriter& writer, const FilmLayers& layers, bool has_regions) {
  uint32_t bits = layers.in_images ? 0 : without_layers;
  if (layers.pixels_are_apart) bits |= with_pixels_apart;
  if (has_regions) bits |= with_regions;
  if (layers.holds_halves()) bits |= with_halves;
  for (int c = 0; c < component_count; ++c)
    if (layers.components.has(Component(c))) bits |= 1u << c;
  writer.put(bits);
  writer.put(uint8_t(layers.bias));
}

FilmLayers get_layers(BinaryReader& reader, bool& has_regions) {
  FilmLayers layers;
  auto bits = reader.get<uint32_t>();
  layers.in_images = (bits & without_layers) == 0;
  layers.pixels_are_apart = (bits & with_pixels_apart) != 0;
  has_regions = (bits & with_regions) != 0;
  layers.halves = !layers.in_images || (bits & with_halves) != 0;
  bits &= ~(without_layers | with_pixels_apart | with_regions | with_halves);
  if (bits >> component_count != 0) reader.damaged("it has components that are not known");
  for (int c = 0; c < component_count; ++c)
    if (bits >> c & 1u) layers.components.add(Component(c));
  layers.bias = reader.get_flag();
  return layers;
}

Vec2i get_size(BinaryReader& reader) {
  const auto width = reader.get<int32_t>(), height = reader.get<int32_t>();
  if (width < 1 || height < 1 || int64_t(width) * height > max_image_pixels)
    reader.damaged("its picture has no valid size");
  return {width, height};
}

}  // namespace

void Film::write(BinaryWriter& writer) const {
  writer.put(int32_t(size_.x));
  writer.put(int32_t(size_.y));
  put_layers(writer, layers_, !regions_.empty());
  writer.put(sample_count_);
  put_passes(writer, passes_);
  put_sums(writer, mean_luminances_);
  write_packed_tiles(writer);
  if (!regions_.empty()) write_regions(writer);
}

Film Film::read(BinaryReader& reader) { return read(read_head(reader), reader); }

Film Film::read(const FilmHead& head, BinaryReader& reader) {
  Film film(head.size, head.layers);
  film.add(head, reader);
  return film;
}

FilmHead Film::read_head(BinaryReader& reader) {
  FilmHead head;
  head.size = get_size(reader);
  head.layers = get_layers(reader, head.has_regions);
  head.samples_per_pixel = reader.get<uint64_t>();
  head.passes = get_passes(reader);
  return head;
}

PassSet Film::add(const FilmHead& head, BinaryReader& reader) {
  add_content(head, reader);
  PassSet twice;
  if (!head.has_regions) return twice;
  for (const FilmRegion& region : read_regions(reader)) {
    for (const FilmRegion& other : regions_)
      if (other.pixels.meets(region.pixels))
        twice.add(other.film.passes_.common(region.film.passes_));
    if (twice.empty()) add_region(region);
  }
  return twice;
}

void Film::add_content(const FilmHead& head, BinaryReader& reader) {
  const std::vector<Fixed> replicates = get_sums(reader, replicate_count);
  add_packed_tiles(reader);
  for (size_t r = 0; r < replicate_count; ++r) add_to(mean_luminances_[r], replicates[r]);
  passes_.add(head.passes);
  sample_count_ += head.samples_per_pixel;
}

void Film::write_regions(BinaryWriter& writer) const {
  writer.put(uint64_t(regions_.size()));
  for (const FilmRegion& region : regions_) {
    writer.put(int32_t(region.pixels.x));
    writer.put(int32_t(region.pixels.y));
    writer.put(uint64_t(region.orders.size()));
    for (const FilmOrder& order : region.orders) {
      writer.put(order.passes.begin);
      writer.put(order.passes.end);
      writer.put(order.stage);
    }
    region.film.write(writer);
  }
}

std::vector<FilmRegion> Film::read_regions(BinaryReader& reader) const {
  std::vector<FilmRegion> regions;
  const uint64_t count = reader.get_count(sizeof(PixelRegion));
  for (uint64_t i = 0; i < count; ++i) {
    const auto x = reader.get<int32_t>(), y = reader.get<int32_t>();
    std::vector<FilmOrder> orders(reader.get_count(sizeof(FilmOrder)));
    PassSet ordered;
    for (FilmOrder& order : orders) {
      order.passes.begin = reader.get<uint32_t>();
      order.passes.end = reader.get<uint32_t>();
      order.stage = reader.get<uint32_t>();
      const bool is_after = ordered.empty() || order.passes.begin >= ordered.ranges().back().end;
      if (order.passes.begin >= order.passes.end || order.passes.end > pass_limit ||
          order.stage >= pass_limit || !is_after)
        reader.damaged("the orders of a region are not valid");
      ordered.add(order.passes);
    }
    // A film in this one has no regions: so none are nested without an end.
    const FilmHead head = read_head(reader);
    if (head.has_regions) reader.damaged("a region of it has regions");
    Film film(head.size, head.layers);
    film.add_content(head, reader);
    const PixelRegion pixels{x, y, head.size.x, head.size.y};
    const bool is_new = regions.empty() || regions.back().pixels < pixels;
    if (!pixels.lies_in(size_) || !(film.layers_ == layers_) || !is_new)
      reader.damaged("a region of it is not valid");
    if (ordered.empty() || ordered.ranges() != film.passes_.ranges())
      reader.damaged("the passes of a region are not those that it was to have");
    for (const FilmRegion& before : regions)
      if (before.pixels.meets(pixels) && !before.film.passes_.common(film.passes_).empty())
        reader.damaged("two regions of it have the same pass for the same pixels");
    regions.push_back({pixels, std::move(film), std::move(orders)});
  }
  if (regions.empty()) reader.damaged("it has no regions, but says so");
  return regions;
}

void Film::write_packed_tiles(BinaryWriter& writer) const {
  // Growing bit by bit would take twice the memory at a time.
  uint64_t size = sizeof(uint32_t) * (tiles_.count() + 1);
  for (const PackedTile& tile : sums_) size += tile.packed().size();
  writer.reserve(size);
  std::vector<std::vector<uint8_t>> packed;
  for (size_t first = 0; first < tiles_.count(); first += packed.size()) {
    packed.resize(std::min(tiles_at_a_time, tiles_.count() - first));
    parallel_blocks(packed.size(), tiles_per_thread, [&](size_t begin, size_t end, size_t) {
      TilePacker packer(numbers_.count);
      for (size_t i = begin; i < end; ++i) {
        const auto bytes = packer.repacked(sums_[first + i]);
        packed[i].assign(bytes.begin(), bytes.end());
      }
    });
    for (const std::vector<uint8_t>& tile : packed) writer.put(uint32_t(tile.size()));
    for (const std::vector<uint8_t>& tile : packed) writer.put_bytes(tile.data(), tile.size());
  }
}

void Film::add_packed_tiles(BinaryReader& reader) {
  reader.need(tiles_.count(), sizeof(uint32_t));
  sums_.resize(tiles_.count());
  PaddedBytes bytes(word_slack);
  for (size_t first = 0; first < tiles_.count(); first += tiles_at_a_time) {
    const size_t count = std::min(tiles_at_a_time, tiles_.count() - first);
    std::vector<uint64_t> ends{0};
    for (const uint32_t size : reader.get_array<uint32_t>(count))
      ends.push_back(ends.back() + size);
    const uint8_t* packed = bytes.of(reader, ends.back());
    std::atomic<bool> is_damaged = false;
    parallel_blocks(count, tiles_per_thread, [&](size_t begin, size_t end, size_t) {
      TilePacker packer(numbers_.count);
      for (size_t i = begin; i < end; ++i) {
        const std::span tile(packed + ends[i], ends[i + 1] - ends[i]);
        if (is_packed_tile(tile, numbers_.count))
          packer.add_packed(sums_[first + i], tile);
        else
          is_damaged = true;
      }
    });
    if (is_damaged) reader.damaged("the sums of a tile in it are not valid");
    reader.skip(ends.back());
  }
}

}  // namespace kaustik
