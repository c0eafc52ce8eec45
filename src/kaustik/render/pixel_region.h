#pragma once
#include <cstdint>
#include <string>
#include <tuple>

#include "kaustik/base/vec.h"

namespace kaustik {

/// A rectangle of pixels of a picture, in its crop window.
struct PixelRegion {
  int x = 0, y = 0, width = 0, height = 0;

  bool holds(int px, int py) const {
    return px >= x && px < x + width && py >= y && py < y + height;
  }
  bool meets(const PixelRegion& other) const {
    return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
           other.y < y + height;
  }
  /// Whether it has pixels, all of them in a picture of this size.
  bool lies_in(const Vec2i& size) const {
    return x >= 0 && y >= 0 && width >= 1 && height >= 1 && width <= size.x - x &&
           height <= size.y - y;
  }
  int64_t pixel_count() const { return int64_t(width) * height; }
  /// "64 x 48 pixels at (10, 20)"
  std::string text() const;
  friend bool operator==(const PixelRegion&, const PixelRegion&) = default;
  friend bool operator<(const PixelRegion& a, const PixelRegion& b) {
    return std::tie(a.y, a.x, a.height, a.width) < std::tie(b.y, b.x, b.height, b.width);
  }
};

}  // namespace kaustik
