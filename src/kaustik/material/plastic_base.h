#pragma once
#include "kaustik/material/bsdf.h"

namespace kaustik {

/// What scatters evenly beneath a transparent coat: light goes in, is scattered, and is thrown back
/// by the coat from below any number of times before it comes out. With T of the coat on both ways,
///   f = T(wo) T(wi) ρ / (π η² (1 − ρ F)),
/// where F is the share of even light that the coat reflects back inside (Kelemen and
/// Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model", 2001). As in Mitsuba ρ in
/// the denominator is 1, so that the colour stays that of the texture, unless `nonlinear`.
class PlasticBase {
 public:
  /// `ratio`: n_interior/n_exterior. `reflected_inside`: F.
  PlasticBase(std::shared_ptr<const Texture> reflectance, bool nonlinear, float ratio,
              float reflected_inside)
      : reflectance_(std::move(reflectance)),
        nonlinear_(nonlinear),
        inverse_ratio_squared_(1 / (ratio * ratio)),
        reflected_inside_(reflected_inside) {}

  SurfaceNeeds needs() const { return texture_needs({reflectance_.get()}); }
  /// f π / (T(wo) T(wi)).
  Spectrum coupled_reflectance(const BsdfContext& context) const {
    const Spectrum once = context.value_of(*reflectance_);
    if (!nonlinear_) return once * (inverse_ratio_squared_ / (1 - reflected_inside_));
    return once * inverse_ratio_squared_ / (Spectrum(1) - once * reflected_inside_);
  }

 private:
  std::shared_ptr<const Texture> reflectance_;
  bool nonlinear_;
  float inverse_ratio_squared_, reflected_inside_;
};

/// The rows that 'plastic' and 'roughplastic' share: diffuse_reflectance, nonlinear, int_ior,
/// ext_ior, specular_reflectance.
std::vector<Parameter> plastic_parameters();
/// n_interior/n_exterior at the wavelength by which glasses are listed: what is dispersed by a coat
/// meets the base all the same.
float plastic_ratio_of(const Arguments& arguments);

}  // namespace kaustik
