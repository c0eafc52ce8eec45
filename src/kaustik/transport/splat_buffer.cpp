#include "kaustik/transport/splat_buffer.h"

#include "kaustik/base/to_integer.h"

namespace kaustik {

SplatBuffer::SplatBuffer(const FilmSettings& film, ComponentSet wanted)
    : size_(film.crop_size),
      filter_(film.filter),
      wanted_(wanted),
      sums_(size_t(size_.x) * size_t(size_.y) * component_count * lanes_) {}

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
      const size_t first = slot(x, y, component);
      for (int lane = 0; lane < lanes_; ++lane)
        sums_[first + size_t(lane)].add(fixed_from(double(rgb[lane]) * weight));
    }
}

Spectrum SplatBuffer::value(int x, int y, Component component) const {
  Spectrum result;
  const size_t first = slot(x, y, component);
  for (int lane = 0; lane < lanes_; ++lane)
    result.set(lane, float(double_from(sums_[first + size_t(lane)].load())));
  return result;
}

void SplatBuffer::clear() {
  for (AtomicFixed& sum : sums_) sum.clear();
  dropped_ = 0;
}

}  // namespace kaustik
