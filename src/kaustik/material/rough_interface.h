#pragma once
#include <memory>
#include <mutex>

#include "kaustik/material/albedo_table.h"
#include "kaustik/material/rough_facets.h"

namespace kaustik {

/// Factors on what a boundary reflects and transmits; 1 is physical.
struct InterfaceFactors {
  Spectrum reflectance, transmittance;
};

/// Shares of the energy.
struct InterfaceAlbedo {
  float reflected = 0, transmitted = 0;
};

/// What even light meets at a rough boundary.
struct EvenLightShares {
  float enters = 0;            ///< of what arrives from outside
  float reflected_inside = 0;  ///< of what arrives from inside
};

/// Directional albedos of rough boundaries, one for all that are alike; tabulated when first asked
/// for.
class InterfaceAlbedos {
 public:
  /// `ratio`: n_interior/n_exterior.
  static std::shared_ptr<const InterfaceAlbedos> of(const FacetRange& facets, float ratio);
  InterfaceAlbedos(const FacetRange& facets, float ratio);

  /// wo on either side.
  InterfaceAlbedo at(float log_alpha, const Vec3f& wo) const;
  /// Where the roughness is the same everywhere.
  const EvenLightShares& of_even_light() const;

 private:
  EvenLightShares find_even_light() const;

  FacetRange facets_;
  float ratio_;
  AlbedoTables from_outside_, from_inside_;
  mutable std::once_flag once_;
  mutable EvenLightShares even_light_;
};

/// The rough boundary of two transparent materials, +z the exterior: facets that each reflect and
/// refract as smooth glass does, with Smith's shadowing; light that meets a second facet is lost
/// (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007). All of it
/// counts as glossy.
class RoughInterface {
 public:
  RoughInterface(RoughFacets facets, const SpectralValue& interior, const SpectralValue& exterior);

  SurfaceNeeds needs() const { return facets_.needs(); }
  /// As Bsdf::values(); either direction may lie on either side.
  BsdfValues values(const BsdfContext& context, const InterfaceFactors& factors, const Vec3f& wo,
                    const Vec3f& wi) const;
  /// As Bsdf::sample(). Lanes with indices of their own go on together, each with what it has in
  /// the direction of the one that was chosen.
  BsdfSample sample(const BsdfContext& context, const InterfaceFactors& factors, const Vec3f& wo,
                    float u_lobe, const Vec2f& u) const;
  /// Of the indices in RGB mode, without factors; wo on either side.
  InterfaceAlbedo albedo(const BsdfContext& context, const Vec3f& wo) const;
  /// Of the indices in RGB mode, where the roughness is the same everywhere.
  const EvenLightShares& of_even_light() const { return albedos_->of_even_light(); }

 private:
  /// n_interior/n_exterior of each lane.
  struct Ratios {
    Spectrum lanes;
    bool are_one = true;  ///< whether all are alike
  };
  Ratios ratios_at(const Wavelengths& wavelengths) const;
  BsdfValues reflected(const BsdfContext& context, const InterfaceFactors& factors, const Vec3f& wo,
                       const Vec3f& wi) const;
  BsdfValues transmitted(const BsdfContext& context, const InterfaceFactors& factors,
                         const Vec3f& wo, const Vec3f& wi) const;

  RoughFacets facets_;
  SpectralValue interior_, exterior_;
  bool is_dispersive_;
  std::shared_ptr<const InterfaceAlbedos> albedos_;
};

}  // namespace kaustik
