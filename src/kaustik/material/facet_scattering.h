#pragma once
#include "kaustik/material/fresnel.h"
#include "kaustik/material/microfacet.h"

namespace kaustik {

/// What facets do that reflect all light, seen from wo, for light from wi on the same side: f, and
/// the densities per solid angle with which their normals are sampled, each way.
struct FacetReflection {
  float cos_facet = 0;    ///< of wo and wi to the normal of the facet that does it; 0: none does
  Vec3f normal{0, 0, 0};  ///< its z is above 0
  float value = 0, pdf = 0, pdf_reverse = 0;
};
/// wo and wi on the same side, either one.
FacetReflection facet_reflection(const MicrofacetDistribution& facets, const Vec3f& wo,
                                 const Vec3f& wi);

/// The same of facets that transmit all light, with what they transmit instead (Walter et al.,
/// "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, section 4). `value` is
/// that of radiance; of flux it is eta² times as much.
struct FacetRefraction {
  float cos_facet = 0;  ///< of wo to the facet's normal (z above 0), signed; 0: no facet does it
  float cos_other = 0;  ///< of wi, of the other sign
  float transmittance = 0;  ///< by Fresnel's equations, the same both ways
  float value = 0, pdf = 0, pdf_reverse = 0;
};
/// wo and wi on opposite sides; `eta`: n on the side of wi over n on that of wo.
FacetRefraction facet_refraction(const MicrofacetDistribution& facets, const Vec3f& wo,
                                 const Vec3f& wi, double eta);

/// Where a facet with normal m sends what comes from wo.
inline Vec3f reflected_by(const Vec3f& m, const Vec3f& wo) { return m * (2 * dot(wo, m)) - wo; }
Vec3f refracted_by(const Vec3f& m, const Vec3f& wo, const DielectricFresnel& fresnel);

/// A facet's normal that wo sees, on whichever side it is; its z is above 0.
inline Vec3f sample_facet(const MicrofacetDistribution& facets, const Vec3f& wo, const Vec2f& u) {
  return facets.sample(wo.z < 0 ? -wo : wo, u);
}

}  // namespace kaustik
