#pragma once
#include <atomic>
#include <memory>
#include <vector>

#include "kaustik/base/exact_sum.h"
#include "kaustik/base/wavelengths.h"
#include "kaustik/scene/film_settings.h"
#include "kaustik/transport/component.h"
#include "kaustik/transport/picture_tiles.h"

namespace kaustik {

/// Exact sums that many threads add to: 64 bits of fraction and 32 of whole numbers each; the 32
/// above are only there once they are needed, for negative numbers and from 4e9 on.
class SplatSums {
 public:
  static constexpr size_t count = 3 * PictureTiles::pixels;
  SplatSums() = default;
  SplatSums(const SplatSums&) = delete;
  SplatSums& operator=(const SplatSums&) = delete;
  ~SplatSums() { delete top_.load(); }

  /// The parts are added apart with a carry: the total is exact once all additions have been made.
  void add(size_t index, Fixed value);
  /// Only when no one adds.
  Fixed load(size_t index) const;
  size_t bytes() const { return sizeof(SplatSums) + (top_.load() ? sizeof(Top) : 0); }

 private:
  using Top = std::array<std::atomic<uint32_t>, count>;
  void add_to_top(size_t index, uint32_t value);

  std::array<std::atomic<uint64_t>, count> fraction_{};
  std::array<std::atomic<uint32_t>, count> whole_{};
  std::atomic<Top*> top_{nullptr};
};

/// Where light paths put what they contribute to pixels of one pass, from all threads at once.
/// Additions are integer adds, so the sum has the same bits whatever their order. Squares of the
/// picture take memory for the components that have come to them.
class SplatBuffer {
 public:
  /// Keeps red, green and blue.
  SplatBuffer(const FilmSettings& film, ComponentSet wanted);
  /// Takes what is of no picture: it wants no component.
  static SplatBuffer nowhere();
  ~SplatBuffer() { clear(); }

  bool wants(Component component) const { return wanted_.has(component); }
  /// `value`: the pixel's radiance if the filter were 1 there, in lanes of `wavelengths`; `raster`
  /// in the crop window. Values that are not finite are counted and dropped.
  void add(const Vec2f& raster, Component component, const Spectrum& value,
           const Wavelengths& wavelengths);
  /// Sum of a pixel, RGB. Only when no one adds.
  Spectrum value(int x, int y, Component component) const;
  /// Forgets what has come to a tile; others may be read at the same time.
  void clear(size_t tile);
  void clear();
  uint64_t dropped() const { return dropped_.load(); }
  /// That its sums take. Only when no one adds.
  size_t bytes() const;

 private:
  static constexpr size_t lanes_ = 3;
  SplatSums& sums(size_t tile, Component component);

  Vec2i size_;
  PictureTiles tiles_;
  PixelFilter filter_;
  ComponentSet wanted_;
  std::vector<std::atomic<SplatSums*>> sums_;  ///< [tile][component], null: all zero
  std::atomic<uint64_t> dropped_{0};
};

}  // namespace kaustik
