// A film as part of a checkpoint: docs/checkpoints.md.
#include "kaustik/base/binary_file.h"
#include "kaustik/render/film.h"
#include "kaustik/render/packed_sums.h"

namespace kaustik {
namespace {

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

void put_components(BinaryWriter& writer, ComponentSet components) {
  uint32_t bits = 0;
  for (int c = 0; c < component_count; ++c)
    if (components.has(Component(c))) bits |= 1u << c;
  writer.put(bits);
}

ComponentSet get_components(BinaryReader& reader) {
  const auto bits = reader.get<uint32_t>();
  if (bits >> component_count != 0) reader.damaged("it has components that are not known");
  ComponentSet components;
  for (int c = 0; c < component_count; ++c)
    if (bits >> c & 1u) components.add(Component(c));
  return components;
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
  put_components(writer, layers_.components);
  writer.put(uint8_t(layers_.bias));
  writer.put(sample_count_);
  put_passes(writer, passes_);
  put_sums(writer, mean_luminances_);
  // Growing bit by bit would take twice the memory at a time.
  writer.reserve(packed_size(numbers_));
  put_sums(writer, numbers_);
}

Film Film::read(BinaryReader& reader) {
  const Vec2i size = get_size(reader);
  const ComponentSet components = get_components(reader);
  Film film(size, {components, reader.get_flag()});
  film.sample_count_ = reader.get<uint64_t>();
  film.passes_ = get_passes(reader);
  const std::vector<Fixed> replicates = get_sums(reader, replicate_count);
  std::copy(replicates.begin(), replicates.end(), film.mean_luminances_.begin());
  film.numbers_ = get_sums(reader, film.pixel_count() * film.numbers_per_pixel());
  return film;
}

}  // namespace kaustik
