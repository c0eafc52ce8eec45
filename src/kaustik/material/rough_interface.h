#pragma once
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

/// The rough boundary of two transparent materials, +z the exterior: facets that each reflect and
/// refract as smooth glass does, with Smith's shadowing; light that meets a second facet is lost
/// (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007). All of it
/// counts as glossy.
class RoughInterface {
 public:
  RoughInterface(RoughFacets facets, const SpectralValue& interior, const SpectralValue& exterior);
  RoughInterface(const RoughInterface&) = delete;  // the tables refer to it
  RoughInterface& operator=(const RoughInterface&) = delete;

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
  /// Of even light from inside, where the roughness is the same everywhere.
  InterfaceAlbedo of_even_light_inside() const;

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
  /// An estimate of the directional albedo, from a facet that is drawn: lane 0 has what it
  /// reflects, lane 1 what it transmits.
  Spectrum shares_of(const MicrofacetDistribution& facets, const Vec3f& wo, const Vec2f& u) const;
  /// Of light that arrives from outside (or inside).
  AlbedoTables albedo_tables(bool outside) const;

  RoughFacets facets_;
  SpectralValue interior_, exterior_;
  bool is_dispersive_;
  AlbedoTables from_outside_, from_inside_;
};

}  // namespace kaustik
