#pragma once
#include <span>
#include <vector>

#include "kaustik/light/emission_cone.h"

namespace kaustik {

/// No light that is partly before a surface is excluded: a shading normal may face what the
/// geometric one hardly does.
inline constexpr float minimum_receiver_cosine = 0.02f;

/// Emission held in bounds: from somewhere within a sphere, brightest about an axis. What light may
/// come from there is told by Conty Estevez and Kulla ("Importance Sampling of Many Lights with
/// Adaptive Tree Splitting", PACMCGIT 2018).
struct EmissionBall {
  Vec3f center{0, 0, 0};
  float radius = 0;
  Vec3f axis{0, 0, 1};
  float cos_spread = -1, sin_spread = 0;  ///< of the angle about the axis of what shines brightest
  float cos_falloff = 1;                  ///< of the angle beyond the spread at which emission ends
  /// Beyond the spread light falls off by 1 − ramp · sine, as that of spots; 0: by the cosine.
  float ramp = 0;
  float intensity = 0;  ///< brightest, W/sr or relative

  EmissionBall() = default;
  /// Of a light with a place; its power may be relative.
  EmissionBall(const LightBounds& bounds, double power);
  /// Not for empty bounds.
  EmissionBall(const Bounds3f& position, const EmissionCone& cone, double brightest);

  /// Intensity times the cosines over the squared distance; the cosines are between the highest
  /// over the sphere and those of its centre, the distance is a mean within it. Zero only where no
  /// light can arrive. `normal`: as of a LightQuery.
  float irradiance(const Vec3f& reference, const Vec3f& normal) const;
};

/// Many balls in blocks that are asked as a whole, laid out for SIMD.
class EmissionBalls {
 public:
  /// What irradiance() writes is a multiple of this.
  static constexpr size_t padding = 8;
  static constexpr size_t padded(size_t count) { return (count + padding - 1) / padding * padding; }

  static constexpr size_t intensity_column = 11, column_count = 12;
  struct Block {
    uint32_t first = 0;  ///< place of its numbers
    uint32_t count = 0;  ///< of balls, padding left out
  };
  Block add(std::span<const EmissionBall> balls);
  /// What EmissionBall::irradiance() tells of each ball of the block but for rounding, in their
  /// order; then zeros up to padded(count).
  void irradiance(const Block& block, const Vec3f& reference, const Vec3f& normal,
                  float* result) const;
  /// Of the balls of a block, zeros behind them.
  const float* intensities(const Block& block) const {
    return columns_.data() + block.first + intensity_column * padded(block.count);
  }

 private:
  std::vector<float> columns_;  ///< of each block one number after the other of all its balls
};

}  // namespace kaustik
