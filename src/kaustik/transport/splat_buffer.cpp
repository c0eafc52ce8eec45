#include "kaustik/transport/splat_buffer.h"

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// What the pointer leads to, made if nothing is there yet; several threads may ask at once.
template <typename T>
T& made_once(std::atomic<T*>& pointer) {
  if (T* there = pointer.load(std::memory_order_acquire)) return *there;
  auto made = std::make_unique<T>();
  T* there = nullptr;
  if (pointer.compare_exchange_strong(there, made.get(), std::memory_order_acq_rel))
    return *made.release();
  return *there;
}

}  // namespace

void SplatSums::add(size_t index, Fixed value) {
  const auto fraction = uint64_t(value);
  auto above = uint64_t(value >> 64);
  if (fraction != 0) {
    const uint64_t before = fraction_[index].fetch_add(fraction, std::memory_order_relaxed);
    if (before + fraction < before) ++above;
  }
  const auto whole = uint32_t(above);
  auto top = uint32_t(above >> 32);
  if (whole != 0) {
    const uint32_t before = whole_[index].fetch_add(whole, std::memory_order_relaxed);
    if (uint32_t(before + whole) < before) ++top;
  }
  if (top != 0) add_to_top(index, top);
}

void SplatSums::add_to_top(size_t index, uint32_t value) {
  made_once(top_)[index].fetch_add(value, std::memory_order_relaxed);
}

Fixed SplatSums::load(size_t index) const {
  const Top* there = top_.load(std::memory_order_acquire);
  const uint64_t top = there ? (*there)[index].load(std::memory_order_relaxed) : 0;
  const uint64_t above = top << 32 | whole_[index].load(std::memory_order_relaxed);
  return Fixed(UnsignedFixed(above) << 64 | fraction_[index].load(std::memory_order_relaxed));
}

SplatBuffer::SplatBuffer(const FilmSettings& film, ComponentSet wanted)
    : size_(film.crop_size),
      tiles_(size_),
      filter_(film.filter),
      wanted_(wanted),
      sums_(tiles_.count() * component_count) {}

SplatBuffer SplatBuffer::nowhere() {
  FilmSettings one_pixel;
  one_pixel.size = one_pixel.crop_size = {1, 1};
  return {one_pixel, ComponentSet()};
}

SplatSums& SplatBuffer::sums(size_t tile, Component component) {
  return made_once(sums_[tile * component_count + size_t(component)]);
}

void SplatBuffer::add(const Vec2f& raster, Component component, const Spectrum& value,
                      const Wavelengths& wavelengths) {
  if (!wanted_.has(component) || value.is_zero()) return;
  const Spectrum rgb = rgb_from_lanes(value, wavelengths);
  if (!rgb.is_finite()) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  const float radius = filter_.radius();
  const int x0 = to_integer(std::ceil(raster.x - radius - 0.5f), 0, size_.x);
  const int y0 = to_integer(std::ceil(raster.y - radius - 0.5f), 0, size_.y);
  const int x1 = to_integer(std::floor(raster.x + radius - 0.5f), -1, size_.x - 1);
  const int y1 = to_integer(std::floor(raster.y + radius - 0.5f), -1, size_.y - 1);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const float weight =
          filter_.eval({raster.x - (float(x) + 0.5f), raster.y - (float(y) + 0.5f)});
      if (weight == 0) continue;
      SplatSums& of_tile = sums(tiles_.tile_at(x, y), component);
      const size_t first = PictureTiles::place_of(x, y) * lanes_;
      for (int lane = 0; lane < int(lanes_); ++lane)
        of_tile.add(first + size_t(lane), fixed_from(double(rgb[lane]) * weight));
    }
}

Spectrum SplatBuffer::value(int x, int y, Component component) const {
  Spectrum result;
  const SplatSums* of_tile = sums_[tiles_.tile_at(x, y) * component_count + size_t(component)];
  if (!of_tile) return result;
  const size_t first = PictureTiles::place_of(x, y) * lanes_;
  for (int lane = 0; lane < int(lanes_); ++lane)
    result.set(lane, float(double_from(of_tile->load(first + size_t(lane)))));
  return result;
}

void SplatBuffer::clear(size_t tile) {
  for (size_t c = 0; c < component_count; ++c)
    delete sums_[tile * component_count + c].exchange(nullptr);
}

void SplatBuffer::clear() {
  for (size_t tile = 0; tile < tiles_.count(); ++tile) clear(tile);
  dropped_ = 0;
}

size_t SplatBuffer::bytes() const {
  size_t sum = sums_.capacity() * sizeof sums_[0];
  for (const std::atomic<SplatSums*>& of_tile : sums_)
    if (const SplatSums* there = of_tile) sum += there->bytes();
  return sum;
}

}  // namespace kaustik
