#include "kaustik/material/burley_facets.h"

#include <utility>

#include "kaustik/material/facet_scattering.h"
#include "kaustik/material/schlick.h"
#include "kaustik/material/shared_by_key.h"

namespace kaustik {
namespace {

constexpr float least_alpha = 1e-3f;

/// How much longer facets are along x than across, as a root; at most 1.
float aspect_of(float anisotropic) { return std::sqrt(1 - 0.9f * anisotropic); }

AlbedoTables glass_albedos(float eta, float anisotropic, bool outside) {
  const auto weight = [=](float roughness, const Vec3f& up, const Vec2f& u) {
    const MicrofacetDistribution facets = burley_facets(roughness, anisotropic);
    const Vec3f m = facets.sample(up, u), wo = outside ? up : -up;
    const float cos_facet = dot(wo, m);
    Spectrum shares;
    if (!(cos_facet * wo.z > 0)) return shares;
    const DielectricFresnel fresnel = fresnel_dielectric(cos_facet, eta);
    const Vec3f back = reflected_by(m, wo), on = refracted_by(m, wo, fresnel);
    if (back.z * wo.z > 0) {
      const float lit = facets.masking(back);
      shares.set(0, lit);
      shares.set(1, lit * schlick_weight(eta >= 1 ? cos_facet : fresnel.cos_transmitted));
      shares.set(2, lit * fresnel.reflectance);
    }
    if (on.z * wo.z < 0) shares.set(3, (1 - fresnel.reflectance) * facets.masking(on));
    return shares;
  };
  return {0, 1, anisotropic == 0, weight};
}

AlbedoTables metal_means(float anisotropic) {
  const auto weight = [=](float roughness, const Vec3f& wo, const Vec2f& u) {
    const MicrofacetDistribution facets = burley_facets(roughness, anisotropic);
    const Vec3f m = facets.sample(wo, u), back = reflected_by(m, wo);
    const float cos_facet = dot(wo, m);
    if (!(cos_facet > 0) || !(back.z > 0)) return Spectrum();
    const float lit = facets.masking(back);
    return Spectrum(lit, lit * schlick_weight(cos_facet), lit * lazanyi_weight(cos_facet), 0);
  };
  return {0, 1, anisotropic == 0, weight};
}

}  // namespace

MicrofacetDistribution burley_facets(float roughness, float anisotropic) {
  const float aspect = aspect_of(anisotropic), alpha = roughness * roughness;
  return {MicrofacetDistribution::Kind::ggx, std::max(least_alpha, alpha / aspect),
          std::max(least_alpha, alpha * aspect)};
}

bool are_smoothest(float roughness, float anisotropic) {
  return roughness * roughness <= least_alpha * aspect_of(anisotropic);
}

std::shared_ptr<const BurleyAlbedos> burley_albedos(float eta, float anisotropic) {
  static SharedByKey<std::pair<float, float>, BurleyAlbedos> all;
  return all.get({eta, anisotropic}, [&] {
    return std::make_shared<const BurleyAlbedos>(
        BurleyAlbedos{.from_outside = glass_albedos(eta, anisotropic, true),
                      .from_inside = glass_albedos(eta, anisotropic, false)});
  });
}

std::shared_ptr<const AlbedoTables> burley_metal_means(float anisotropic) {
  static SharedByKey<float, AlbedoTables> all;
  return all.get(anisotropic,
                 [&] { return std::make_shared<const AlbedoTables>(metal_means(anisotropic)); });
}

}  // namespace kaustik
