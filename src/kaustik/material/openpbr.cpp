#include <optional>

#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/cloth_fuzz.h"
#include "kaustik/material/facet_scattering.h"
#include "kaustik/material/lobe_event.h"
#include "kaustik/material/mask.h"
#include "kaustik/material/openpbr_layers.h"
#include "kaustik/material/oren_nayar.h"
#include "kaustik/material/schlick.h"
#include "kaustik/material/thin_sheet.h"

namespace kaustik {
namespace {

/// What both sides of a sheet of glass reflect together, where one reflects `once`, if nothing is
/// absorbed between them.
float both_sides(float once) { return 2 * once / (1 + once); }

/// OpenPBR Surface: fibres over a coat over a base that is metal, glass or matt beneath a surface.
/// No more light leaves than arrives: see OpenPbrLayers. Skin and wax are matt here. From behind
/// only what is of glass is seen, but of a sheet, whose sides are alike.
class OpenPbr final : public Bsdf {
 public:
  explicit OpenPbr(OpenPbrParameters parameters)
      : Bsdf({.lobes = Lobes::diffuse | Lobes::glossy,
              .transmits = parameters.may_transmit(),
              .passes_straight = parameters.may_be_pane(),
              .is_lambertian = false,
              .needs = parameters.needs()}),
        parameters_(std::move(parameters)),
        layers_(parameters_),
        metal_means_(burley_metal_means(parameters_.mean_anisotropic())) {
    if (parameters_.has_constant_surface())
      constant_mean_ = layers_.mean_beneath_gloss(parameters_.at({}));
    if (parameters_.has_constant_layers() && (parameters_.has_coat() || parameters_.has_fuzz()))
      attenuation_.emplace(attenuation_tables());
  }
  OpenPbr(const OpenPbr&) = delete;  // the tables refer to it
  OpenPbr& operator=(const OpenPbr&) = delete;

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    const BsdfValues values =
        answer(context, parameters_.at(context), wo, wi, lobes, Densities::none);
    return values.diffuse + values.glossy;
  }
  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    return answer(context, parameters_.at(context), wo, wi, lobes, Densities::forward).pdf;
  }
  Spectrum straight(const BsdfContext& context, const Vec3f& wo) const override {
    if (!traits().passes_straight || wo.z == 0) return Spectrum();
    const OpenPbrLook look = parameters_.at(context);
    if (!parameters_.is_pane(look)) return Spectrum();
    const Vec3f o = seen_from(wo);
    return passed_by(look, o.z, sqr(layers_.beneath_coat(look, o)));
  }
  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    return answer(context, parameters_.at(context), wo, wi, Lobes::all, Densities::both);
  }
  void all_values(const BsdfContext& context, const Vec3f& wo, std::span<Vec3f> wi,
                  std::span<BsdfValues> result) const override {
    const OpenPbrLook look = parameters_.at(context);
    for (size_t i = 0; i < wi.size(); ++i)
      result[i] = answer(context, look, wo, wi[i], Lobes::all, Densities::both);
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (wo.z == 0) return {};
    const OpenPbrLook look = parameters_.at(context);
    const Vec3f from = seen_from(wo);
    const Chances chances = chances_of(look, from, lobes);
    float rest = u_lobe, eta = 1;
    Vec3f wi;
    if (rest < chances.matt) {
      rest /= chances.matt;
      wi = square_to_cosine_hemisphere(u);
    } else if ((rest -= chances.matt) < chances.matt_on) {
      rest /= chances.matt_on;
      wi = beyond(square_to_cosine_hemisphere(u));
    } else if ((rest -= chances.matt_on) < chances.coat) {
      rest /= chances.coat;
      wi = reflected_by(coat_facets(look).sample(from, u), from);
      if (!(wi.z > 0)) return {};
    } else if ((rest -= chances.coat) < chances.passed) {
      rest /= chances.passed;
      wi = beyond(reflected_by(sheet_facets(look).sample(from, u), from));
      if (!(wi.z < 0)) return {};
    } else {
      if (!(chances.facets > 0)) return {};
      rest = std::clamp((rest - chances.passed) / chances.facets, 0.0f, one_minus_epsilon);
      const Vec3f m = sample_facet(facets(look), from, u);
      const float cos_facet = dot(from, m);
      if (!(cos_facet * from.z > 0)) return {};
      const float through = chance_through(look, from.z > 0, cos_facet);
      if (rest < 1 - through) {
        rest /= 1 - through;
        wi = reflected_by(m, from);
        if (!(wi.z * from.z > 0)) return {};
      } else {
        rest = (rest - (1 - through)) / through;
        const DielectricFresnel fresnel = fresnel_dielectric(cos_facet, parameters_.base_eta());
        wi = refracted_by(m, from, fresnel);
        eta = fresnel.eta;
        if (!(wi.z * from.z < 0)) return {};
      }
    }
    if (wi.z == 0) return {};
    if (parameters_.is_sheet() && wo.z < 0) wi = beyond(wi);
    const BsdfValues values = answer(context, look, wo, wi, lobes, Densities::forward);
    BsdfSample sample =
        sample_with_event(wi, values.diffuse, values.glossy, values.pdf, wi.z * wo.z < 0,
                          std::clamp(rest, 0.0f, one_minus_epsilon));
    sample.eta = eta;
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z == 0) return Spectrum();
    const OpenPbrLook look = parameters_.at(context);
    const Vec3f from = seen_from(wo);
    const Albedos albedos = albedos_of(look, from);
    Spectrum sum;
    if (any(lobes & Lobes::diffuse)) {
      sum += albedos.fuzz;
      if (from.z > 0 && look.opaque() > 0) {
        const float mean = mean_of(context, look);
        sum += (layers_.matt_albedo(look, matt_color(look), from.z, mean) +
                layers_.matt_albedo(look, matt_on_color(look), from.z, mean)) *
               (layers_.beneath_gloss(look, from.z) * look.opaque()) * tint(look);
      }
    }
    if (any(lobes & Lobes::glossy))
      sum += albedos.coat + albedos.reflected + albedos.through + albedos.passed;
    return sum;
  }

 private:
  /// Directional albedos of the lobes; `matt` for a matt part without roughness.
  struct Albedos {
    Spectrum fuzz, matt, matt_on, coat, reflected, through, passed;
  };
  /// With which sample() takes each; the facets reflect and let through.
  struct Chances {
    float matt = 0, matt_on = 0, coat = 0, passed = 0, facets = 0;
  };

  /// Which densities are asked for; what is not is 0.
  enum class Densities { none, forward, both };

  /// Of a sheet both sides are the outer one.
  Vec3f seen_from(const Vec3f& w) const { return parameters_.is_sheet() ? raised(w) : w; }

  static MicrofacetDistribution facets(const OpenPbrLook& look) {
    return burley_facets(look.roughness, look.anisotropic);
  }
  static MicrofacetDistribution coat_facets(const OpenPbrLook& look) {
    return burley_facets(look.coat_roughness, look.coat_anisotropic);
  }
  MicrofacetDistribution sheet_facets(const OpenPbrLook& look) const {
    return burley_facets(sheet_roughness(look.roughness, parameters_.base_eta()), look.anisotropic);
  }

  // ---- colours ----

  /// Of what comes back from beneath the coat.
  Spectrum tint(const OpenPbrLook& look) const {
    return look.coat > 0 ? layers_.coat_tint(look) * layers_.darkening(look) : look.white;
  }
  /// Of what passes the coat once.
  Spectrum tint_once(const OpenPbrLook& look) const {
    return look.coat > 0 ? sqrt(layers_.coat_tint(look)) : look.white;
  }
  Spectrum matt_color(const OpenPbrLook& look) const {
    const float back = parameters_.is_sheet() ? 0.5f * (1 - parameters_.forward()) : 1.0f;
    return look.base_color * (1 - look.subsurface) +
           look.subsurface_color * (look.subsurface * back);
  }
  Spectrum matt_on_color(const OpenPbrLook& look) const {
    if (!parameters_.is_sheet()) return Spectrum();
    return look.subsurface_color * (look.subsurface * 0.5f * (1 + parameters_.forward()));
  }

  /// Toward its edge it has the specular colour times as much as by Schlick's approximation (Kutz,
  /// Hašan and Edmondson, "Novel Aspects of the Adobe Standard Material", 2021).
  static LazanyiMetal metal(const OpenPbrLook& look) {
    const Spectrum schlick =
        look.base_color + (look.white - look.base_color) * schlick_weight(lazanyi_cosine);
    return LazanyiMetal::through(look.base_color, look.white, schlick * look.specular_color);
  }

  /// What a facet of the base reflects to the outer side.
  Spectrum outer_reflectance(const OpenPbrLook& look, float cos_facet) const {
    Spectrum sum;
    if (look.metalness > 0)
      sum += metal(look).reflectance(cos_facet) * (look.specular_weight * look.metalness);
    if (look.metalness < 1) {
      const float once = layers_.surface_reflectance(look, cos_facet);
      const float of_glass = parameters_.is_sheet() ? both_sides(once) : once;
      sum += look.specular_color * (look.opaque() * once + look.clear() * of_glass);
    }
    return sum;
  }
  Spectrum inner_reflectance(const OpenPbrLook& look, float cos_facet) const {
    return look.white * (look.clear() * layers_.inner_reflectance(look, cos_facet));
  }
  /// What a facet of glass lets through, for flux, by the cosine on its outer side.
  Spectrum through(const OpenPbrLook& look, float cos_outside) const {
    return look.transmission_color *
           (look.clear() * (1 - layers_.surface_reflectance(look, cos_outside)));
  }
  /// Chance with which a facet that was chosen lets light through.
  float chance_through(const OpenPbrLook& look, bool from_outside, float cos_facet) const {
    if (parameters_.is_sheet() || !(look.clear() > 0)) return 0;
    const DielectricFresnel fresnel = fresnel_dielectric(cos_facet, parameters_.base_eta());
    if (fresnel.cos_transmitted == 0) return 0;
    const float outside = from_outside ? std::fabs(cos_facet) : fresnel.cos_transmitted;
    return chance_of_through(look, from_outside, std::fabs(cos_facet), outside);
  }
  float chance_of_through(const OpenPbrLook& look, bool from_outside, float cos_facet,
                          float cos_outside) const {
    const Spectrum back =
        from_outside ? outer_reflectance(look, cos_facet)
                     : look.white * (look.clear() * layers_.surface_reflectance(look, cos_outside));
    const float on = through(look, cos_outside).max_lane(), sum = back.max_lane() + on;
    return sum > 0 ? on / sum : 0.0f;
  }

  // ---- values ----

  BsdfValues answer(const BsdfContext& context, const OpenPbrLook& look, const Vec3f& wo,
                    const Vec3f& wi, Lobes lobes, Densities asked) const {
    BsdfValues result;
    if (wo.z * wi.z == 0 || !any(lobes & traits().lobes)) return result;
    const bool is_through = wo.z * wi.z < 0;
    const Vec3f o = seen_from(wo);
    const Vec3f i = parameters_.is_sheet() ? raised(wi) : wi;
    if ((o.z < 0 || (is_through && !parameters_.is_sheet())) && !(look.clear() > 0)) return result;
    const Chances none;
    const Chances chances = asked == Densities::none ? none : chances_of(look, o, lobes);
    const Chances reverse = asked == Densities::both ? chances_of(look, i, lobes) : none;
    const bool has_gloss = any(lobes & Lobes::glossy), has_matt = any(lobes & Lobes::diffuse);
    if (!is_through) {
      if (has_gloss) add_mirrored(look, o, i, chances, reverse, result);
      if (o.z > 0) add_matt(context, look, o, i, has_matt, chances, reverse, result);
    } else if (parameters_.is_sheet()) {
      add_passed(context, look, o, i, has_gloss, has_matt, chances, reverse, result);
    } else if (has_gloss) {
      add_refracted(context, look, o, i, chances, reverse, result);
    }
    return result;
  }

  /// Coat and base, or the base from inside.
  void add_mirrored(const OpenPbrLook& look, const Vec3f& o, const Vec3f& i, const Chances& chances,
                    const Chances& reverse, BsdfValues& result) const {
    const bool is_outside = o.z > 0;
    const FacetReflection base = facet_reflection(facets(look), o, i);
    if (base.cos_facet != 0) {
      const float back = 1 - chance_through(look, is_outside, base.cos_facet);
      if (is_outside) {
        const float share = std::min(layers_.beneath_coat(look, o), layers_.beneath_coat(look, i));
        result.glossy +=
            outer_reflectance(look, base.cos_facet) * tint(look) * (share * base.value);
      } else {
        result.glossy += inner_reflectance(look, base.cos_facet) * base.value;
      }
      result.pdf += chances.facets * back * base.pdf;
      result.pdf_reverse += reverse.facets * back * base.pdf_reverse;
    }
    if (!is_outside || !(look.coat > 0)) return;
    const FacetReflection coat = facet_reflection(coat_facets(look), o, i);
    if (coat.cos_facet == 0) return;
    const float share = std::min(layers_.beneath_fuzz(look, o), layers_.beneath_fuzz(look, i));
    result.glossy +=
        look.white * (look.coat * layers_.coat_reflectance(coat.cos_facet) * share * coat.value);
    result.pdf += chances.coat * coat.pdf;
    result.pdf_reverse += reverse.coat * coat.pdf_reverse;
  }

  /// What is matt, and fibres.
  void add_matt(const BsdfContext& context, const OpenPbrLook& look, const Vec3f& o, const Vec3f& i,
                bool has_matt, const Chances& chances, const Chances& reverse,
                BsdfValues& result) const {
    if (has_matt && look.opaque() > 0)
      result.diffuse += OrenNayar(look.diffuse_roughness).eval(matt_color(look), o, i) *
                        tint(look) * (look.opaque() * coupling(context, look, o, i));
    if (has_matt && look.fuzz > 0)
      result.diffuse += look.fuzz_color * (look.fuzz * cloth_fuzz(o, i, look.fuzz_roughness));
    result.pdf += chances.matt * cosine_hemisphere_pdf(i.z);
    result.pdf_reverse += reverse.matt * cosine_hemisphere_pdf(o.z);
  }

  /// Through the glass of a sheet and the layers of both sides, which leave `share` of it.
  Spectrum passed_by(const OpenPbrLook& look, float cos_facet, float share) const {
    const float back = both_sides(layers_.surface_reflectance(look, cos_facet));
    return look.transmission_color * sqr_of(tint_once(look)) * (look.clear() * (1 - back) * share);
  }

  /// On through a sheet, whose sides both have the layers.
  void add_passed(const BsdfContext& context, const OpenPbrLook& look, const Vec3f& o,
                  const Vec3f& i, bool has_gloss, bool has_matt, const Chances& chances,
                  const Chances& reverse, BsdfValues& result) const {
    if (has_gloss && look.clear() > 0 && !parameters_.is_pane(look)) {
      const FacetReflection facet = facet_reflection(sheet_facets(look), o, i);
      if (facet.cos_facet != 0) {
        const float share = layers_.beneath_coat(look, o) * layers_.beneath_coat(look, i);
        result.glossy = passed_by(look, facet.cos_facet, share) * facet.value;
        result.pdf = chances.passed * facet.pdf;
        result.pdf_reverse = reverse.passed * facet.pdf_reverse;
      }
    }
    if (has_matt && look.opaque() > 0)
      result.diffuse = OrenNayar(look.diffuse_roughness).eval(matt_on_color(look), o, i) *
                       tint(look) * (look.opaque() * coupling(context, look, o, i));
    result.pdf += chances.matt_on * cosine_hemisphere_pdf(i.z);
    result.pdf_reverse += reverse.matt_on * cosine_hemisphere_pdf(o.z);
  }

  void add_refracted(const BsdfContext& context, const OpenPbrLook& look, const Vec3f& o,
                     const Vec3f& i, const Chances& chances, const Chances& reverse,
                     BsdfValues& result) const {
    const bool is_outside = o.z > 0;
    const double ratio = parameters_.base_eta(), eta = is_outside ? ratio : 1 / ratio;
    const FacetRefraction facet = facet_refraction(facets(look), o, i, eta);
    if (facet.cos_facet == 0) return;
    const float cos_o = std::fabs(facet.cos_facet), cos_i = std::fabs(facet.cos_other);
    const float outside = is_outside ? cos_o : cos_i;
    result.glossy = through(look, outside) * tint_once(look) *
                    (layers_.beneath_coat(look, is_outside ? o : i) * facet.value);
    if (context.mode == TransportMode::flux) result.glossy *= float(sqr(eta));
    result.pdf = chances.facets * facet.pdf * chance_of_through(look, is_outside, cos_o, outside);
    result.pdf_reverse =
        reverse.facets * facet.pdf_reverse * chance_of_through(look, !is_outside, cos_i, outside);
  }

  static Spectrum sqr_of(const Spectrum& s) { return s * s; }

  /// Of what is matt, for this pair of directions on the outer side.
  float coupling(const BsdfContext& context, const OpenPbrLook& look, const Vec3f& o,
                 const Vec3f& i) const {
    return layers_.beneath_gloss(look, o.z) * layers_.beneath_gloss(look, i.z) /
           mean_of(context, look);
  }
  float mean_of(const BsdfContext& context, const OpenPbrLook& look) const {
    if (constant_mean_ > 0) return constant_mean_;
    return context.number_of(this, [&] { return layers_.mean_beneath_gloss(look); });
  }

  // ---- albedos ----

  Albedos albedos_of(const OpenPbrLook& look, const Vec3f& wo) const {
    Albedos albedos;
    if (wo.z < 0) {
      if (!(look.clear() > 0)) return albedos;
      const OpenPbrLayers::SurfaceAlbedo inner = layers_.inner_albedo(look, wo);
      albedos.reflected = look.white * (look.clear() * inner.reflected);
      albedos.through = look.transmission_color * tint_once(look) *
                        (look.clear() * inner.through * attenuation_from_inside(look, wo));
      return albedos;
    }
    const float share = attenuation_from_outside(look, wo);
    const Spectrum color = tint(look);
    if (look.fuzz > 0)
      albedos.fuzz = look.fuzz_color * (look.fuzz * cloth_fuzz_albedo(wo.z, look.fuzz_roughness));
    if (look.coat > 0)
      albedos.coat =
          look.white * (look.coat * layers_.beneath_fuzz(look, wo) * layers_.coat_albedo(look, wo));
    if (look.metalness > 0) {
      const Spectrum means = (*metal_means_)(look.roughness, wo);
      albedos.reflected += metal(look).reflectance(means[0], means[1], means[2]) * color *
                           (look.specular_weight * look.metalness * share);
    }
    if (look.metalness < 1) add_dielectric_albedos(look, wo, color, share, albedos);
    return albedos;
  }

  void add_dielectric_albedos(const OpenPbrLook& look, const Vec3f& wo, const Spectrum& color,
                              float share, Albedos& albedos) const {
    const OpenPbrLayers::SurfaceAlbedo surface = layers_.surface_albedo(look, look.roughness, wo);
    const bool is_sheet = parameters_.is_sheet();
    const float of_glass = is_sheet ? of_sheet(surface).reflected : surface.reflected;
    albedos.reflected += look.specular_color * color *
                         ((look.opaque() * surface.reflected + look.clear() * of_glass) * share);
    if (look.opaque() > 0) {
      // As beneath_gloss(), but for what the azimuth makes of it.
      const float beneath =
          layers_.beneath_coat(look, wo) * (1 - surface.reflected) * look.opaque();
      albedos.matt = matt_color(look) * color * beneath;
      albedos.matt_on = matt_on_color(look) * color * beneath;
    }
    if (!(look.clear() > 0)) return;
    if (is_sheet && !parameters_.is_pane(look)) {
      const OpenPbrLayers::SurfaceAlbedo on = of_sheet(layers_.surface_albedo(
          look, sheet_roughness(look.roughness, parameters_.base_eta()), wo));
      albedos.passed = look.transmission_color * sqr_of(tint_once(look)) *
                       (look.clear() * on.through * layers_.beneath_coat(look, wo) *
                        attenuation_beyond(look, wo));
    } else if (!is_sheet) {
      albedos.through = look.transmission_color * tint_once(look) *
                        (look.clear() * surface.through * layers_.beneath_coat(look, wo));
    }
  }
  static OpenPbrLayers::SurfaceAlbedo of_sheet(const OpenPbrLayers::SurfaceAlbedo& side) {
    const float whole = std::max(1e-6f, side.whole);
    const float back = side.whole * both_sides(std::min(1.0f, side.reflected / whole));
    return {side.whole, back, side.whole - back};
  }

  Chances chances_of(const OpenPbrLook& look, const Vec3f& wo, Lobes lobes) const {
    const Albedos albedos = albedos_of(look, wo);
    Chances chances;
    if (any(lobes & Lobes::diffuse)) {
      chances.matt = (albedos.fuzz + albedos.matt).max_lane();
      chances.matt_on = albedos.matt_on.max_lane();
    }
    if (any(lobes & Lobes::glossy)) {
      chances.coat = albedos.coat.max_lane();
      chances.passed = albedos.passed.max_lane();
      chances.facets = (albedos.reflected + albedos.through).max_lane();
    }
    const float total =
        chances.matt + chances.matt_on + chances.coat + chances.passed + chances.facets;
    if (!(total > 0)) return {};
    return {chances.matt / total, chances.matt_on / total, chances.coat / total,
            chances.passed / total, chances.facets / total};
  }

  // ---- what layers leave of what facets of the base reflect ----

  /// Means over what facets send where: of the smaller share of both directions (lane 0) over that
  /// of all (lane 1), and of what reaches the outer side through glass, or the other side of a
  /// sheet (lane 2 over lane 3).
  AlbedoTables attenuation_tables() const {
    const OpenPbrLook layers = parameters_.at({});
    return {0, 1, layers.anisotropic == 0 && layers.coat_anisotropic == 0,
            [this, layers](float roughness, const Vec3f& wo, const Vec2f& u) {
              const MicrofacetDistribution facets = burley_facets(roughness, layers.anisotropic);
              const Vec3f m = facets.sample(wo, u), back = reflected_by(m, wo);
              Spectrum shares;
              if (back.z > 0) {
                const float lit = facets.masking(back);
                shares.set(0, lit * std::min(layers_.beneath_coat(layers, wo),
                                             layers_.beneath_coat(layers, back)));
                shares.set(1, lit);
              }
              if (parameters_.is_sheet())
                add_passed_shares(layers, roughness, wo, u, shares);
              else
                add_refracted_shares(layers, facets, m, wo, shares);
              return shares;
            }};
  }
  void add_refracted_shares(const OpenPbrLook& layers, const MicrofacetDistribution& facets,
                            const Vec3f& m, const Vec3f& wo, Spectrum& shares) const {
    const DielectricFresnel fresnel = fresnel_dielectric(-dot(wo, m), parameters_.base_eta());
    const Vec3f on = refracted_by(m, -wo, fresnel);
    if (!(fresnel.cos_transmitted > 0) || !(on.z > 0)) return;
    const float lit = (1 - fresnel.reflectance) * facets.masking(on);
    shares.set(2, lit * layers_.beneath_coat(layers, on));
    shares.set(3, lit);
  }
  void add_passed_shares(const OpenPbrLook& layers, float roughness, const Vec3f& wo,
                         const Vec2f& u, Spectrum& shares) const {
    const MicrofacetDistribution facets =
        burley_facets(sheet_roughness(roughness, parameters_.base_eta()), layers.anisotropic);
    const Vec3f on = reflected_by(facets.sample(wo, u), wo);
    if (!(on.z > 0)) return;
    const float lit = facets.masking(on);
    shares.set(2, lit * layers_.beneath_coat(layers, on));
    shares.set(3, lit);
  }
  float attenuation_from_outside(const OpenPbrLook& look, const Vec3f& wo) const {
    const float beneath = layers_.beneath_coat(look, wo);
    if (!attenuation_) return beneath;
    const Spectrum shares = (*attenuation_)(look.roughness, wo);
    return shares[1] > 0 ? std::min(beneath, shares[0] / shares[1]) : beneath;
  }
  /// On the other side of a sheet.
  float attenuation_beyond(const OpenPbrLook& look, const Vec3f& wo) const {
    if (!attenuation_) return layers_.beneath_coat(look, wo);
    const Spectrum shares = (*attenuation_)(look.roughness, wo);
    return shares[3] > 0 ? shares[2] / shares[3] : layers_.beneath_coat(look, wo);
  }
  float attenuation_from_inside(const OpenPbrLook& look, const Vec3f& wo) const {
    if (attenuation_) {
      const Spectrum shares = (*attenuation_)(look.roughness, {wo.x, wo.y, -wo.z});
      if (shares[3] > 0) return shares[2] / shares[3];
    }
    const DielectricFresnel fresnel = fresnel_dielectric(wo.z, parameters_.base_eta());
    const float cosine = std::max(fresnel.cos_transmitted, 0.05f);
    return layers_.beneath_coat(look, {safe_sqrt(1 - cosine * cosine), 0, cosine});
  }

  OpenPbrParameters parameters_;
  OpenPbrLayers layers_;
  std::shared_ptr<const AlbedoTables> metal_means_;
  float constant_mean_ = 0;  ///< 0: it has to be found at each point
  std::optional<AlbedoTables> attenuation_;
};

const TypeInfo& openpbr_info() {
  static const TypeInfo info{
      "bsdf", "openpbr",
      "OpenPBR Surface: matt, skin, plastic, metal, glass, sheets, with a coat and fibres.",
      OpenPbrParameters::rows()};
  return info;
}

std::shared_ptr<const Bsdf> create_openpbr(const BsdfInputs& inputs) {
  const auto surface = std::make_shared<OpenPbr>(OpenPbrParameters(inputs));
  const auto opacity = inputs.texture("geometry_opacity");
  if (opacity->is_constant() && opacity->mean().max_lane() >= 1) return surface;
  return make_mask(surface, opacity);
}

}  // namespace

BsdfType openpbr_type() { return {openpbr_info(), 0, 0, create_openpbr}; }

}  // namespace kaustik
