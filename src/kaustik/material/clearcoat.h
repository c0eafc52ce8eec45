#pragma once
#include <memory>

#include "kaustik/material/albedo_table.h"

namespace kaustik {

/// Burley's coat of varnish: a thin sharp lobe with a wide foot (GTR1), "Physically Based Shading
/// at Disney" (2012), for directions on the outer side. f is 0 where no light is, and has no factor
/// for the coat's weight.
class Clearcoat {
 public:
  /// `gloss` from 0 (satin) to 1. `eta`: of what is coated, which tells the angle where it is less
  /// dense than what surrounds it.
  Clearcoat(float gloss, float eta);

  float eval(const Vec3f& wo, const Vec3f& wi) const;
  float pdf(const Vec3f& wo, const Vec3f& wi) const;
  /// May lie on the inner side.
  Vec3f sample(const Vec3f& wo, const Vec2f& u) const;

 private:
  float density(const Vec3f& m) const;

  float alpha_sq_, eta_;
};

/// Directional albedos of such coats by their gloss, 0 … 1, good to some percent; one for all with
/// the same `eta`.
std::shared_ptr<const AlbedoTables> clearcoat_albedos(float eta);

}  // namespace kaustik
