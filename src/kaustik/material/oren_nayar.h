#pragma once
#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Matt facets, for directions on the outer side: Fujii's form of Oren and Nayar's model, and
/// beside it what is scattered between facets, so that white is white at every roughness
/// (Portsmouth, Kutz and Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT 2025).
class OrenNayar {
 public:
  /// From 0 (Lambert's) to 1.
  explicit OrenNayar(float roughness);

  /// f of facets of that colour.
  Spectrum eval(const Spectrum& color, const Vec3f& wo, const Vec3f& wi) const;
  /// π times the mean of f over the azimuth, of two cosines.
  Spectrum around(const Spectrum& color, float cos_o, float cos_i) const;
  /// Directional albedo.
  Spectrum albedo(const Spectrum& color, float cosine) const;

 private:
  /// Directional albedo of what white facets scatter once.
  float albedo_of_once(float cosine) const;
  /// Albedo of what is scattered more than once.
  Spectrum several_times(const Spectrum& color) const;
  /// Which share of that is scattered between these two cosines, over its mean.
  float between(float cos_o, float cos_i) const;

  float roughness_;
  float scale_;  ///< A of Fujii's form
  float mean_;   ///< of albedo_of_once() over even light
};

}  // namespace kaustik
