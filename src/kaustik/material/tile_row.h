#pragma once
#include <algorithm>
#include <cmath>

namespace kaustik {

/// Tiles along one axis: from 0 to `size`, then a joint, and so on with a given period. Lengths in
/// m.
struct TileRow {
  float size, period;

  /// Share of tile between x − width/2 and x + width/2.
  float coverage(float x, float width) const {
    const float rest = x - std::floor(x / period) * period;
    if (!(width > 1e-6f * period)) return rest < size ? 1.0f : 0.0f;
    // From the row's nearest start: far out, floats would lose narrow footprints.
    const float begin = rest - 0.5f * width, end = rest + 0.5f * width;
    return (tile_before(end) - tile_before(begin)) / (end - begin);
  }

 private:
  /// Length of tile between 0 and x.
  float tile_before(float x) const {
    const float whole = std::floor(x / period);
    return whole * size + std::min(x - whole * period, size);
  }
};

}  // namespace kaustik
