#include "kaustik/material/openpbr_layers.h"

#include <array>

#include "kaustik/material/cloth_fuzz.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/material/oren_nayar.h"
#include "kaustik/material/schlick.h"

namespace kaustik {
namespace {

constexpr size_t even_light_steps = 32;

/// Cosines from 0 to 1, denser where albedos bend.
float even_light_cosine(size_t step) { return sqr((float(step) + 0.5f) / float(even_light_steps)); }
/// The mean over them of f(step), weighted as light from everywhere is.
template <typename F>
auto over_even_light(const F& f) {
  constexpr auto steps = float(even_light_steps);
  constexpr float sum_of_weights = 1 - 1 / (2 * steps * steps);
  auto sum = f(size_t(0)) * 0.0f;
  for (size_t i = 0; i < even_light_steps; ++i) {
    const float root = (float(i) + 0.5f) / steps;
    sum += f(i) * (4 * root * root * root / (steps * sum_of_weights));
  }
  return sum;
}

float normal_reflectance_of(float eta) { return sqr((eta - 1) / (eta + 1)); }

}  // namespace

OpenPbrLayers::OpenPbrLayers(const OpenPbrParameters& parameters)
    : coat_eta_(parameters.coat_eta()),
      coat_normal_(normal_reflectance_of(parameters.coat_eta())),
      coat_inside_(reflectance_of_even_light(1 / parameters.coat_eta())) {
  const float anisotropic = parameters.mean_anisotropic();
  bare_ = surface_of(parameters.base_eta(), anisotropic);
  if (!parameters.has_coat()) return;
  // A base less dense than its coat would reflect all light at some angles, which light that comes
  // through the coat never meets: it is taken to be denser by as much.
  const float eta = parameters.base_eta() / coat_eta_;
  coated_ = surface_of(std::max({eta, 1 / eta, 1.0001f}), anisotropic);
  coat_albedos_ = burley_albedos(coat_eta_, parameters.mean_coat_anisotropic());
}

OpenPbrLayers::Surface OpenPbrLayers::surface_of(float eta, float anisotropic) {
  return {eta, normal_reflectance_of(eta), burley_albedos(eta, anisotropic)};
}

/// The weight lowers what is reflected at normal incidence, and nothing along the surface.
float OpenPbrLayers::Surface::reflectance(float weight, float cos_facet) const {
  const DielectricFresnel fresnel = fresnel_dielectric(cos_facet, eta);
  const float grazing = schlick_weight(eta >= 1 ? cos_facet : fresnel.cos_transmitted);
  return std::max(0.0f, fresnel.reflectance - (1 - weight) * normal_reflectance * (1 - grazing));
}
float OpenPbrLayers::Surface::albedo(float weight, const Spectrum& shares) const {
  return std::max(0.0f, shares[2] - (1 - weight) * normal_reflectance * (shares[0] - shares[1]));
}

float OpenPbrLayers::surface_reflectance(const OpenPbrLook& look, float cos_facet) const {
  const float bare = bare_.reflectance(look.specular_weight, cos_facet);
  if (!(look.coat > 0)) return bare;
  return std::lerp(bare, coated_.reflectance(look.specular_weight, cos_facet), look.coat);
}

float OpenPbrLayers::inner_reflectance(const OpenPbrLook& look, float cos_facet) const {
  const DielectricFresnel fresnel = fresnel_dielectric(-std::fabs(cos_facet), bare_.eta);
  if (fresnel.cos_transmitted == 0) return 1;
  return surface_reflectance(look, fresnel.cos_transmitted);
}

OpenPbrLayers::SurfaceAlbedo OpenPbrLayers::surface_albedo(const OpenPbrLook& look, float roughness,
                                                           const Vec3f& wo) const {
  const Spectrum shares = bare_.albedos->from_outside(roughness, wo);
  float reflected = bare_.albedo(look.specular_weight, shares);
  if (look.coat > 0)
    reflected = std::lerp(
        reflected,
        coated_.albedo(look.specular_weight, coated_.albedos->from_outside(roughness, wo)),
        look.coat);
  // What the surface reflects less than that of its index it lets through.
  const float usual = std::max(1e-6f, shares[0] - shares[2]);
  const float through = shares[3] * std::max(0.0f, shares[0] - reflected) / usual;
  return {shares[0], reflected, through};
}

OpenPbrLayers::SurfaceAlbedo OpenPbrLayers::inner_albedo(const OpenPbrLook& look,
                                                         const Vec3f& wo) const {
  const Spectrum shares = bare_.albedos->from_inside(look.roughness, {wo.x, wo.y, std::fabs(wo.z)});
  const float factor =
      (1 - surface_reflectance(look, 1)) / std::max(1e-6f, 1 - bare_.normal_reflectance);
  const float through = shares[3] * factor;
  return {shares[0], std::clamp(shares[2] + shares[3] - through, 0.0f, shares[0]), through};
}

float OpenPbrLayers::coat_reflectance(float cos_facet) const {
  return fresnel_dielectric(cos_facet, coat_eta_).reflectance;
}
float OpenPbrLayers::coat_albedo(const OpenPbrLook& look, const Vec3f& wo) const {
  return coat_albedos_->from_outside(look.coat_roughness, wo)[2];
}

float OpenPbrLayers::beneath_fuzz(const OpenPbrLook& look, const Vec3f& w) const {
  return look.fuzz > 0 ? 1 - look.fuzz * cloth_fuzz_albedo(w.z, look.fuzz_roughness) : 1.0f;
}
float OpenPbrLayers::beneath_coat(const OpenPbrLook& look, const Vec3f& w) const {
  const float share = beneath_fuzz(look, w);
  return look.coat > 0 ? share * (1 - look.coat * coat_albedo(look, w)) : share;
}
float OpenPbrLayers::beneath_gloss(const OpenPbrLook& look, float cosine) const {
  const float sine = safe_sqrt(1 - cosine * cosine);
  const auto along = [&](const Vec3f& w) {
    return beneath_coat(look, w) *
           std::max(0.0f, 1 - surface_albedo(look, look.roughness, w).reflected);
  };
  const float share = along({sine, 0, cosine});
  if (look.anisotropic == 0 && look.coat_anisotropic == 0) return share;
  return std::min(share, along({0, sine, cosine}));
}

float OpenPbrLayers::mean_beneath_gloss(const OpenPbrLook& look) const {
  std::array<float, even_light_steps> beneath;
  for (size_t i = 0; i < even_light_steps; ++i)
    beneath[i] = beneath_gloss(look, even_light_cosine(i));
  // A surface that reflects all light leaves none.
  float most = std::max(1e-6f, over_even_light([&](size_t i) { return beneath[i]; }));
  if (!(look.diffuse_roughness > 0)) return most;
  const OrenNayar matt(look.diffuse_roughness);
  for (const float cosine : {1.0f, 0.85f, 0.7f, 0.55f, 0.4f, 0.25f, 0.1f, 0.02f})
    most = std::max(most, over_even_light([&](size_t i) {
                      return matt.around(Spectrum(1), cosine, even_light_cosine(i))[0] * beneath[i];
                    }));
  return most;
}

Spectrum OpenPbrLayers::matt_albedo(const OpenPbrLook& look, const Spectrum& color, float cos_o,
                                    float mean) const {
  if (!(look.diffuse_roughness > 0)) return color;
  const OrenNayar matt(look.diffuse_roughness);
  return over_even_light([&](size_t i) {
           const float cosine = even_light_cosine(i);
           return matt.around(color, cos_o, cosine) * beneath_gloss(look, cosine);
         }) /
         mean;
}

Spectrum OpenPbrLayers::coat_tint(const OpenPbrLook& look) const {
  return look.white * (1 - look.coat) + look.coat_color * look.coat;
}

Spectrum OpenPbrLayers::darkening(const OpenPbrLook& look) const {
  const float weight = look.coat * look.coat_darkening;
  if (!(weight > 0)) return look.white;
  // Specification, section "Darkening": by the albedo of the base at normal incidence and the share
  // of what leaves it that the coat throws back, more for matt bases than for mirrors.
  const float surface = surface_reflectance(look, 1);
  const Spectrum dielectric =
      look.white * surface + look.base_color * ((1 - surface) * (1 - look.transmission));
  const Spectrum base =
      dielectric * (1 - look.metalness) + look.base_color * (look.metalness * look.specular_weight);
  const float dielectric_roughness = std::lerp(1.0f, look.roughness, surface);
  const float roughness = std::lerp(dielectric_roughness, look.roughness, look.metalness);
  const float back = std::lerp(coat_normal_, coat_inside_, roughness);
  const Spectrum darker = Spectrum(1 - back) / (Spectrum(1) - base * back);
  return look.white * (Spectrum(1 - weight) + darker * weight);
}

}  // namespace kaustik
