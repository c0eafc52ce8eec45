#pragma once
#include <algorithm>
#include <cmath>
#include <compare>
#include <memory>
#include <vector>

#include "kaustik/material/bsdf.h"
#include "kaustik/material/microfacet.h"

namespace kaustik {

/// Which roughnesses facets have: all that the albedos of what is made of them depend on.
struct FacetRange {
  MicrofacetDistribution::Kind kind = MicrofacetDistribution::Kind::beckmann;
  float least_log_alpha = 0, largest_log_alpha = 0;  ///< along u
  bool is_isotropic = true;
  float across = 0;  ///< the mean one along v where it differs

  MicrofacetDistribution at(float log_alpha) const {
    const float alpha = std::exp2(log_alpha);
    return {kind, alpha, is_isotropic ? alpha : across};
  }
  friend auto operator<=>(const FacetRange&, const FacetRange&) = default;
};

/// Microscopic facets whose roughness varies over the surface. What a number or a texture says
/// beyond least_alpha and largest_alpha is taken to these ends: black paint means as smooth as can
/// be.
class RoughFacets {
 public:
  using Kind = MicrofacetDistribution::Kind;
  using TexturePointer = std::shared_ptr<const Texture>;

  static constexpr double least_alpha = 1e-3, largest_alpha = 10;

  RoughFacets(Kind kind, TexturePointer alpha_u, TexturePointer alpha_v)
      : kind_(kind), alpha_u_(std::move(alpha_u)), alpha_v_(std::move(alpha_v)) {}

  /// The same where both may be the same constant, which then is isotropic.
  static RoughFacets of_pair(Kind kind, TexturePointer alpha_u, TexturePointer alpha_v) {
    if (alpha_u->is_constant() && alpha_v->is_constant() && alpha_u->mean() == alpha_v->mean())
      alpha_v = alpha_u;
    return {kind, std::move(alpha_u), std::move(alpha_v)};
  }

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
  FacetRange range() const {
    FacetRange range{.kind = kind_, .is_isotropic = is_isotropic()};
    if (alpha_u_->is_constant()) {
      range.least_log_alpha = range.largest_log_alpha = log_alpha({});
    } else {
      range.least_log_alpha = std::log2(float(least_alpha));
      range.largest_log_alpha = std::log2(in_range(alpha_u_->maximum()));
    }
    if (!range.is_isotropic) range.across = in_range(luminance_of(alpha_v_->mean()));
    return range;
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

/// The rows of the distribution and of Mitsuba's choice of sampling, and what the first says. Of
/// Mitsuba 0.6 are "phong" and "as" (Ashikhmin and Shirley's): there, too, their exponents come
/// from alpha, as 2/alpha² − 2. They are Beckmann's here, which is nearly the same, with a warning.
Parameter distribution_parameter();
Parameter sample_visible_parameter();
RoughFacets::Kind facet_kind_of(const BsdfInputs& inputs);
/// The row of a roughness; `name` is alpha, alpha_u or alpha_v.
Parameter alpha_parameter(const std::string& name, const std::string& sentence);

}  // namespace kaustik
