#pragma once
#include <memory>

#include "kaustik/material/bsdf.h"
#include "kaustik/material/fresnel.h"

namespace kaustik {

/// The index of a metal that reflects `reflectance` at normal incidence, from 1e-6 to 0.999;
/// `edge`, from 0 to 1, tells how much it reflects toward the edge: 1 as much as a metal can
/// (Gulbrandsen, "Artist Friendly Metallic Fresnel", JCGT 2014, equations 5 to 8).
ComplexIor ior_of_metal(const Spectrum& reflectance, const Spectrum& edge);

/// What smooth pieces of a metal reflect: by its index of refraction, or by two colours, which may
/// vary over the surface.
class MetalFresnel {
 public:
  explicit MetalFresnel(const SpectralIor& ior) : ior_(ior) {}
  MetalFresnel(std::shared_ptr<const Texture> reflectance, std::shared_ptr<const Texture> edge)
      : reflectance_(std::move(reflectance)), edge_(std::move(edge)) {}

  bool is_constant() const {
    return !reflectance_ || (reflectance_->is_constant() && edge_->is_constant());
  }
  SurfaceNeeds needs() const {
    return reflectance_ ? texture_needs({reflectance_.get(), edge_.get()}) : SurfaceNeeds::none;
  }
  ComplexIor at(const BsdfContext& context) const {
    return reflectance_ ? ior_of_metal(context.value_of(*reflectance_), context.value_of(*edge_))
                        : ior_.at(context.wavelengths());
  }

 private:
  SpectralIor ior_;
  std::shared_ptr<const Texture> reflectance_, edge_;  ///< null: by the index
};

}  // namespace kaustik
