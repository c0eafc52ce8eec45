#pragma once
#include "kaustik/light/emission_ball.h"

namespace kaustik {

/// How light falls from the beam to the cutoff.
enum class SpotFalloff {
  linear,  ///< with the angle, as Mitsuba's
  smooth,  ///< by 3t² − 2t³, where t falls linearly with the cosine, as pbrt's
  square   ///< by t², as glTF's
};

/// The falloff of a spot light about +z: 1 within the beam, falling to 0 at the cutoff. Angles in
/// radians, 0 ≤ beam ≤ cutoff ≤ π, cutoff > 0.
class SpotCone {
 public:
  SpotCone(double cutoff, double beam, SpotFalloff falloff = SpotFalloff::linear);

  /// In [0, 1], for a unit direction.
  float falloff(const Vec3f& local) const;
  /// The falloff over all directions, sr.
  float solid_angle() const { return solid_angle_; }
  float cos_cutoff() const { return 1.0f - cutoff_height_; }
  float cutoff() const { return cutoff_; }
  /// Of a light within `position` that shines by the falloff about `axis`.
  EmissionBall emission_ball(const Bounds3f& position, const Vec3f& axis, double intensity) const;

  /// A direction with a density close to the falloff: constant within the beam, linear in cosθ
  /// outside, so that falloff/density differs by at most 2 over the cone (for cutoffs up to 90°).
  Vec3f sample(const Vec2f& u) const;
  /// Density of sample(), per solid angle.
  float pdf(const Vec3f& local) const;

 private:
  float pdf_at(float height) const;
  /// 1 at the beam, 0 at the cutoff, linear in the height.
  float share_at(float height) const {
    return (cutoff_height_ - height) / (cutoff_height_ - beam_height_);
  }

  // Heights are 1 − cosθ: proportional to solid angle, and exact for narrow cones.
  SpotFalloff kind_;
  float cutoff_, inv_transition_;
  float beam_height_, cutoff_height_;
  float mass_;  ///< of the unnormalised density over the height
  float solid_angle_;
};

}  // namespace kaustik
