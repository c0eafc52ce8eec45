#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/exact_sum.h"
#include "kaustik/base/wavelengths.h"
#include "kaustik/scene/film_settings.h"
#include "kaustik/transport/component.h"

namespace kaustik {

/// Where light paths put what they contribute to pixels of one pass, from all threads at once.
/// Additions are integer adds, so the sum has the same bits whatever their order.
class SplatBuffer {
 public:
  /// Keeps red, green and blue.
  SplatBuffer(const FilmSettings& film, ComponentSet wanted);

  bool wants(Component component) const { return wanted_.has(component); }
  /// `value`: the pixel's radiance if the filter were 1 there, in lanes of `wavelengths`; `raster`
  /// in the crop window. Values that are not finite are counted and dropped.
  void add(const Vec2f& raster, Component component, const Spectrum& value,
           const Wavelengths& wavelengths);
  /// Sum of a pixel, RGB. Only when no one adds.
  Spectrum value(int x, int y, Component component) const;
  void clear();
  uint64_t dropped() const { return dropped_.load(); }

 private:
  static constexpr int lanes_ = 3;
  size_t slot(int x, int y, Component component) const {
    return ((size_t(y) * size_t(size_.x) + size_t(x)) * component_count + size_t(component)) *
           lanes_;
  }
  Vec2i size_;
  PixelFilter filter_;
  ComponentSet wanted_;
  std::vector<AtomicFixed> sums_;
  std::atomic<uint64_t> dropped_{0};
};

}  // namespace kaustik
