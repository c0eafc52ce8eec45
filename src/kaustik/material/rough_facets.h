#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "kaustik/material/bsdf.h"
#include "kaustik/material/microfacet.h"

namespace kaustik {

/// Microscopic facets whose roughness varies over the surface. What a number or a texture says beyond
/// least_alpha and largest_alpha is taken to these ends: black paint means as smooth as can be.
class RoughFacets {
 public:
  using Kind = MicrofacetDistribution::Kind;
  using TexturePointer = std::shared_ptr<const Texture>;

  static constexpr double least_alpha = 1e-3, largest_alpha = 10;

  RoughFacets(Kind kind, TexturePointer alpha_u, TexturePointer alpha_v)
      : kind_(kind), alpha_u_(std::move(alpha_u)), alpha_v_(std::move(alpha_v)) {}

  bool is_isotropic() const { return alpha_u_ == alpha_v_; }
  SurfaceNeeds needs() const {
    const SurfaceNeeds textures = texture_needs({alpha_u_.get(), alpha_v_.get()});
    return is_isotropic() ? textures : textures | SurfaceNeeds::tangent;
  }
  MicrofacetDistribution at(const BsdfContext& context) const {
    return {kind_, in_range(context.scalar_of(*alpha_u_)), in_range(context.scalar_of(*alpha_v_))};
  }
  /// Of the roughness along u, which albedos are tabulated by.
  float log_alpha(const BsdfContext& context) const {
    return std::log2(in_range(context.scalar_of(*alpha_u_)));
  }
  float least_log_alpha() const {
    return alpha_u_->is_constant() ? log_alpha({}) : std::log2(float(least_alpha));
  }
  float largest_log_alpha() const {
    return alpha_u_->is_constant() ? log_alpha({}) : std::log2(in_range(alpha_u_->maximum()));
  }
  /// With a given roughness along u and, where it differs, the mean one along v.
  MicrofacetDistribution of_log_alpha(float log_alpha) const {
    const float alpha = std::exp2(log_alpha);
    const float across = is_isotropic() ? alpha : in_range(luminance_of(alpha_v_->mean()));
    return {kind_, alpha, across};
  }

 private:
  static float in_range(float alpha) {
    return std::clamp(alpha, float(least_alpha), float(largest_alpha));
  }

  Kind kind_;
  TexturePointer alpha_u_, alpha_v_;
};

/// The rows that rough surfaces share: distribution, alpha, alpha_u, alpha_v, sample_visible.
std::vector<Parameter> rough_facets_parameters();
/// What they say. Throws Error(input) if alpha is given together with one of the others, or only
/// one of these.
RoughFacets rough_facets_of(const BsdfInputs& inputs);

/// The rows of the distribution and of Mitsuba's choice of sampling, and what the first says.
Parameter distribution_parameter();
Parameter sample_visible_parameter();
RoughFacets::Kind facet_kind_of(const Arguments& arguments);

}  // namespace kaustik
