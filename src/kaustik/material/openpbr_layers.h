#pragma once
#include <memory>

#include "kaustik/material/burley_facets.h"
#include "kaustik/material/openpbr_look.h"

namespace kaustik {

/// How the layers of 'openpbr' share the light: fibres over a coat over a base with a surface of
/// its own. Light that a layer has not reflected reaches what is beneath it. What leaves again is
/// attenuated such that directions may be exchanged: f of facets by the smaller share of both
/// directions, f of what is matt by the product of both, over its mean (as in the specification's
/// reciprocal form of albedo scaling). Directions lie on the outer side.
class OpenPbrLayers {
 public:
  explicit OpenPbrLayers(const OpenPbrParameters& parameters);

  /// Shares of light that arrives beneath the fibres, beneath the coat …
  float beneath_fuzz(const OpenPbrLook& look, const Vec3f& w) const;
  float beneath_coat(const OpenPbrLook& look, const Vec3f& w) const;
  /// … and in what is matt, by the cosine alone: the least share over the azimuth.
  float beneath_gloss(const OpenPbrLook& look, float cosine) const;
  /// What the product of two beneath_gloss() is divided by: the mean over even light; where the
  /// matt part has a roughness, as much more as keeps its albedo below 1.
  float mean_beneath_gloss(const OpenPbrLook& look) const;
  /// Directional albedo over beneath_gloss(), of a matt part of that colour.
  Spectrum matt_albedo(const OpenPbrLook& look, const Spectrum& color, float cos_o,
                       float mean) const;

  /// What a facet of the coat reflects.
  float coat_reflectance(float cos_facet) const;
  /// Directional albedo of the coat where there is one.
  float coat_albedo(const OpenPbrLook& look, const Vec3f& wo) const;

  /// What a facet of the dielectric base's surface reflects, without colour, by the cosine on its
  /// outer side. Where there is a coat, the base borders on that.
  float surface_reflectance(const OpenPbrLook& look, float cos_facet) const;
  /// The same from inside, where all may be reflected.
  float inner_reflectance(const OpenPbrLook& look, float cos_facet) const;
  /// Directional albedos of the base's facets.
  struct SurfaceAlbedo {
    float whole = 0;      ///< if all were reflected
    float reflected = 0;  ///< of the surface of a dielectric
    float through = 0;    ///< let through by glass, for flux
  };
  SurfaceAlbedo surface_albedo(const OpenPbrLook& look, float roughness, const Vec3f& wo) const;
  SurfaceAlbedo inner_albedo(const OpenPbrLook& look, const Vec3f& wo) const;

  /// What the coat does to the colour of what is beneath it, for light that has passed it twice.
  Spectrum coat_tint(const OpenPbrLook& look) const;
  /// What light that the coat throws back to the base again loses there.
  Spectrum darkening(const OpenPbrLook& look) const;

 private:
  /// A dielectric surface with one index: F0 is scaled by the look's weight.
  struct Surface {
    float eta = 1, normal_reflectance = 0;
    std::shared_ptr<const BurleyAlbedos> albedos;

    float reflectance(float weight, float cos_facet) const;
    float albedo(float weight, const Spectrum& shares) const;
  };
  static Surface surface_of(float eta, float anisotropic);

  Surface bare_, coated_;  ///< of the base
  float coat_eta_, coat_normal_, coat_inside_;
  std::shared_ptr<const BurleyAlbedos> coat_albedos_;
};

}  // namespace kaustik
