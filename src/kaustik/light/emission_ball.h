#pragma once
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
  float intensity = 0;                    ///< brightest, W/sr or relative

  EmissionBall() = default;
  /// Of a light with a place; its power may be relative.
  EmissionBall(const LightBounds& bounds, double power);
  /// Not for empty bounds.
  EmissionBall(const Bounds3f& position, const EmissionCone& cone, double brightest);

  /// Intensity times the cosines over the squared distance, each at its highest over the sphere;
  /// within the sphere the mean. Zero only where no light can arrive. `normal`: as of a LightQuery.
  float irradiance(const Vec3f& reference, const Vec3f& normal) const;
};

/// Many balls, laid out for SIMD.
class EmissionBalls {
 public:
  void add(const EmissionBall& ball);
  size_t size() const { return intensity_.size(); }
  /// What EmissionBall::irradiance() tells of each, in their order.
  void irradiance(const Vec3f& reference, const Vec3f& normal, float* result) const;

 private:
  using Column = std::vector<float>;
  Column center_[3], radius_, axis_[3], cos_spread_, sin_spread_, cos_falloff_, intensity_;
};

}  // namespace kaustik
