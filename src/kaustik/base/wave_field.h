#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// What a field of water waves looks like.
struct WaveSettings {
  float amplitude = 0.004f;  ///< root mean square of the height, m
  float wavelength = 0.5f;   ///< of the longest waves, m
  int count = 40;            ///< number of waves
  float direction = 0;       ///< toward which they run, degrees from +x toward +y
  float spread = 180;        ///< their directions differ by up to this, degrees; 180: all ways
  float time = 0;            ///< s
  uint64_t seed = 0;
};

/// Height of water over a plane: a sum of sine waves, from the longest to a sixteenth of that, each
/// running at the speed of its length (gravity and surface tension on deep water).
class WaveField {
 public:
  explicit WaveField(const WaveSettings& settings);

  /// m, its mean over a disk of diameter `width`.
  float height(const Vec2f& at, float width = 0) const;
  /// Of the same mean, m per m.
  Vec2f slope(const Vec2f& at, float width = 0) const;
  /// No height is over this, m.
  float largest_height() const { return largest_; }

 private:
  struct Wave {
    Vec2f wave_vector;  ///< 1/m
    float amplitude;    ///< m
    float phase;
  };
  std::vector<Wave> waves_;
  float largest_ = 0;
};

}  // namespace kaustik
