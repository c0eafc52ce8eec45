#include "kaustik/material/facet_scattering.h"

namespace kaustik {
namespace {

Vec3f turned_up(const Vec3f& m) { return m.z < 0 ? -m : m; }

/// Whether a facet shows w the side that w lies on.
bool faces(const Vec3f& w, float cos_facet) { return cos_facet * w.z > 0; }

}  // namespace

FacetReflection facet_reflection(const MicrofacetDistribution& facets, const Vec3f& wo,
                                 const Vec3f& wi) {
  FacetReflection result;
  const Vec3f m = turned_up(normalize(wo + wi));
  // The same both ways to the last bit: near total reflection Fresnel's equations are steep.
  const float cos_facet = 0.5f * (dot(wo, m) + dot(wi, m));
  if (!faces(wo, cos_facet)) return result;
  const float density = facets.density(m), seen = facets.masking(wo), lit = facets.masking(wi);
  const float jacobian = 1 / (4 * std::fabs(cos_facet));
  result.cos_facet = cos_facet;
  result.normal = m;
  result.value = density * seen * lit / (4 * std::fabs(wo.z * wi.z));
  result.pdf = facets.pdf(wo, m, density, seen) * jacobian;
  result.pdf_reverse = facets.pdf(wi, m, density, lit) * jacobian;
  return result;
}

FacetRefraction facet_refraction(const MicrofacetDistribution& facets, const Vec3f& wo,
                                 const Vec3f& wi, double eta) {
  FacetRefraction result;
  // Snell's law: what both have along the surface of the facet cancels. So much does that single
  // precision would not do.
  const Vec3d exact_wo(wo), exact_wi(wi), sum = exact_wo + exact_wi * eta;
  const double sum_sq = dot(sum, sum);
  if (!(sum_sq > 1e-12)) return result;
  const Vec3d normal = sum * ((sum.z < 0 ? -1 : 1) / std::sqrt(sum_sq));
  const double cos_o = dot(exact_wo, normal), cos_i = dot(exact_wi, normal);
  if (!faces(wo, float(cos_o)) || !faces(wi, float(cos_i))) return result;
  const Vec3f m(normal);
  const float density = facets.density(m), seen = facets.masking(wo), lit = facets.masking(wi);
  const double o = std::fabs(cos_o), i = std::fabs(cos_i);
  result.cos_facet = float(cos_o);
  result.cos_other = float(cos_i);
  // From both cosines, in a form in which nothing cancels.
  result.transmittance =
      float(std::min(1.0, 2 * eta * o * i * (1 / sqr(o + eta * i) + 1 / sqr(eta * o + i))));
  // sum_sq is (cos_o + eta cos_i)².
  result.value = float(o * i / sum_sq) * density * seen * lit / std::fabs(wo.z * wi.z);
  result.pdf = facets.pdf(wo, m, density, seen) * float(sqr(eta) * i / sum_sq);
  result.pdf_reverse = facets.pdf(wi, m, density, lit) * float(o / sum_sq);
  return result;
}

Vec3f refracted_by(const Vec3f& m, const Vec3f& wo, const DielectricFresnel& fresnel) {
  const float cos_o = dot(wo, m), inv_eta = 1 / fresnel.eta;
  return normalize(m * (cos_o * inv_eta - std::copysign(fresnel.cos_transmitted, cos_o)) -
                   wo * inv_eta);
}

}  // namespace kaustik
