#include "kaustik/material/clearcoat.h"

#include "kaustik/material/facet_scattering.h"
#include "kaustik/material/schlick.h"
#include "kaustik/material/shared_by_key.h"

namespace kaustik {
namespace {

constexpr float roughest = 0.1f, smoothest = 0.001f;
/// By which roughness facets hide one another, whatever the gloss.
constexpr float masking_alpha = 0.25f;
constexpr float coat_reflectance = 0.04f, coat_weight = 0.25f;

float coat_masking(const Vec3f& w) {
  return MicrofacetDistribution(MicrofacetDistribution::Kind::ggx, masking_alpha, masking_alpha)
      .masking(w);
}

}  // namespace

Clearcoat::Clearcoat(float gloss, float eta)
    : alpha_sq_(sqr(std::lerp(roughest, smoothest, std::clamp(gloss, 0.0f, 1.0f)))), eta_(eta) {}

float Clearcoat::density(const Vec3f& m) const {
  return (alpha_sq_ - 1) /
         (pi * std::log(alpha_sq_) * (alpha_sq_ * m.z * m.z + m.x * m.x + m.y * m.y));
}

float Clearcoat::eval(const Vec3f& wo, const Vec3f& wi) const {
  const Vec3f m = normalize(wo + wi);
  const float cosine = dot(wo, m);
  const float angle = eta_ >= 1 ? cosine : fresnel_dielectric(cosine, eta_).cos_transmitted;
  const float fresnel = std::lerp(coat_reflectance, 1.0f, schlick_weight(angle));
  return coat_weight * fresnel * density(m) * coat_masking(wo) * coat_masking(wi);
}

float Clearcoat::pdf(const Vec3f& wo, const Vec3f& wi) const {
  const Vec3f m = normalize(wo + wi);
  const float cosine = dot(wo, m);
  return cosine > 0 ? density(m) * m.z / (4 * cosine) : 0.0f;
}

Vec3f Clearcoat::sample(const Vec3f& wo, const Vec2f& u) const {
  const float cos_sq = (1 - std::pow(alpha_sq_, 1 - u.y)) / (1 - alpha_sq_);
  const float sine = safe_sqrt(1 - cos_sq), phi = 2 * pi * u.x;
  return reflected_by({sine * std::cos(phi), sine * std::sin(phi), safe_sqrt(cos_sq)}, wo);
}

std::shared_ptr<const AlbedoTables> clearcoat_albedos(float eta) {
  static SharedByKey<float, AlbedoTables> all;
  // From 1 on it makes no difference.
  const float key = std::min(eta, 1.0f);
  return all.get(key, [&] {
    return std::make_shared<const AlbedoTables>(
        0.0f, 1.0f, true, [key](float gloss, const Vec3f& from, const Vec2f& u) {
          const Clearcoat coat(gloss, key);
          const Vec3f wi = coat.sample(from, u);
          const float pdf = wi.z > 0 ? coat.pdf(from, wi) : 0.0f;
          return Spectrum(pdf > 0 ? coat.eval(from, wi) * wi.z / pdf : 0.0f);
        });
  });
}

}  // namespace kaustik
