#pragma once
#include "kaustik/base/vec.h"

namespace kaustik {

/// Distribution of the normals of a rough surface made of mirrors, with Smith's shadowing (Walter
/// et al., "Microfacet Models for Refraction", EGSR 2007). Directions are local, z the mean normal.
class MicrofacetDistribution {
 public:
  enum class Kind { beckmann, ggx };

  /// Roughness along x and y, > 0.
  MicrofacetDistribution(Kind kind, float alpha_x, float alpha_y)
      : kind_(kind), alpha_x_(alpha_x), alpha_y_(alpha_y) {}

  bool is_isotropic() const { return alpha_x_ == alpha_y_; }
  float alpha_x() const { return alpha_x_; }
  float alpha_y() const { return alpha_y_; }

  /// D(m): area of the facets with normal m per area of the surface and solid angle.
  float density(const Vec3f& m) const;
  /// G1: share of the facets facing w that no others hide; w.z > 0. Exact for both kinds.
  float masking(const Vec3f& w) const;
  /// One of the normals that w sees, with m.z > 0; w.z > 0. Dupuy and Benyoub, "Sampling Visible
  /// GGX Normals with Spherical Caps" (2023); for Beckmann Jakob, "An Improved Visible Normal
  /// Sampling Routine" (2014). Weights of samples are at most 1; drawn from all normals they had no
  /// variance.
  Vec3f sample(const Vec3f& w, const Vec2f& u) const;
  /// Density per solid angle of the normals with which sample() finds m; dot(w, m) > 0.
  float pdf(const Vec3f& w, const Vec3f& m) const { return pdf(w, m, density(m), masking(w)); }
  /// The same where density(m) and masking(w) are known.
  float pdf(const Vec3f& w, const Vec3f& m, float density, float masking) const {
    return density * masking * dot(w, m) / w.z;
  }

 private:
  Vec3f sample_ggx(const Vec3f& w, const Vec2f& u) const;
  Vec3f sample_beckmann(const Vec3f& w, const Vec2f& u) const;

  Kind kind_;
  float alpha_x_, alpha_y_;
};

}  // namespace kaustik
