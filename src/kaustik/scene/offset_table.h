#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "kaustik/base/to_integer.h"

namespace kaustik {

/// Offsets from a pixel's centre along one axis, drawn from a distribution function that has no
/// closed inverse.
class OffsetTable {
 public:
  /// `distribution(x)`: the share of offsets below x, for x from -radius to radius in pixels.
  template <typename Distribution>
  OffsetTable(float radius, const Distribution& distribution) : radius_(radius) {
    float so_far = 0;
    for (size_t i = 0; i <= cells; ++i) {
      const float x = radius_ * (2 * float(i) / float(cells) - 1);
      // By rounding the tails would not rise everywhere.
      so_far = std::clamp(distribution(x), so_far, 1.0f);
      cdf_.push_back(so_far);
    }
    cdf_.front() = 0;
    cdf_.back() = 1;
    for (size_t i = 0, cell = 0; i < cells; ++i) {
      while (cdf_[cell + 1] <= float(i) / float(cells)) ++cell;
      guide_.push_back(uint16_t(cell));
    }
  }

  /// Rises with u in [0, 1).
  float sample(float u) const {
    size_t cell = guide_[to_integer(u * float(cells), size_t(0), cells - 1)];
    while (cell + 1 < cells && cdf_[cell + 1] <= u) ++cell;
    const float inside = (u - cdf_[cell]) / (cdf_[cell + 1] - cdf_[cell]);
    return radius_ * (2 * (float(cell) + inside) / float(cells) - 1);
  }

 private:
  static constexpr size_t cells = 1024;

  float radius_;
  /// The distribution function at evenly spaced offsets, and for evenly spaced values of it the
  /// last of these below.
  std::vector<float> cdf_;
  std::vector<uint16_t> guide_;
};

}  // namespace kaustik
