#include <array>

#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/burley_diffuse.h"
#include "kaustik/material/burley_facets.h"
#include "kaustik/material/facet_scattering.h"
#include "kaustik/material/lobe_event.h"
#include "kaustik/material/most_reflected.h"
#include "kaustik/material/schlick.h"
#include "kaustik/material/share.h"
#include "kaustik/material/thin_sheet.h"

namespace kaustik {
namespace {

struct ThinShares {
  Share roughness, anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness;
  Share diff_trans;  ///< 0 … 2

  std::array<const Share*, 8> all() const {
    return {&roughness, &anisotropic, &spec_trans, &spec_tint,
            &sheen,     &sheen_tint,  &flatness,   &diff_trans};
  }
};

/// All that the parameters say of one point.
struct ThinLook {
  Spectrum base, tint;  ///< the colour, and the same at a luminance of 1
  float roughness = 0, anisotropic = 0, spec_trans = 0, spec_tint = 0, sheen = 0, sheen_tint = 0,
        flatness = 0;
  float onward = 0;  ///< share of the matt part that goes through

  float matt_back() const { return (1 - spec_trans) * (1 - onward); }
  float matt_on() const { return (1 - spec_trans) * onward; }
  Spectrum sheen_color() const {
    return (Spectrum(1 - sheen_tint) + tint * sheen_tint) * (sheen * matt_back());
  }
};

/// Burley's thin sheet ("Extending the Disney BRDF to a BSDF with Integrated Subsurface
/// Scattering", 2015, section 5), as in Mitsuba: alike on both sides; a matt part, of which a share
/// goes through, and a glassy part, which light leaves in the direction in which it came, but for
/// the facets. Where the lobes together would scatter more light than arrives, all of them are
/// scaled down.
class PrincipledThin final : public Bsdf {
 public:
  PrincipledThin(std::shared_ptr<const Texture> base_color, ThinShares shares, float eta)
      : Bsdf(
            {.lobes = shares.spec_trans.is_zero() ? Lobes::diffuse : Lobes::diffuse | Lobes::glossy,
             .transmits = !shares.spec_trans.is_zero() || !shares.diff_trans.is_zero(),
             .passes_straight = may_be_pane(shares, eta),
             .is_lambertian = false,
             .needs = needs_of(*base_color, shares)}),
        base_color_(std::move(base_color)),
        shares_(std::move(shares)),
        eta_(eta),
        normal_reflectance_(sqr((eta - 1) / (eta + 1))),
        facet_albedos_(burley_albedos(eta, shares_.anisotropic.mean())) {
    bool is_constant = base_color_->is_constant();
    for (const Share* share : shares_.all()) is_constant = is_constant && share->is_constant();
    if (is_constant) constant_scale_ = scale_of_look(look_at({}));
  }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    const BsdfValues values = answer(context, look_at(context), wo, wi, lobes);
    return values.diffuse + values.glossy;
  }
  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    return answer(context, look_at(context), wo, wi, lobes).pdf;
  }
  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    return answer(context, look_at(context), wo, wi, Lobes::all);
  }
  Spectrum straight(const BsdfContext& context, const Vec3f& wo) const override {
    if (!traits().passes_straight || wo.z == 0) return Spectrum();
    const ThinLook look = look_at(context);
    return straight_of(look, raised(wo)) * scale_of(context, look);
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (wo.z == 0) return {};
    const ThinLook look = look_at(context);
    const Vec3f up = raised(wo);
    const Chances chances = chances_of(look, up, lobes);
    Vec3f wi;
    float rest = u_lobe;
    if (rest < chances.matt_back) {
      rest /= chances.matt_back;
      wi = square_to_cosine_hemisphere(u);
    } else if ((rest -= chances.matt_back) < chances.matt_on) {
      rest /= chances.matt_on;
      wi = beyond(square_to_cosine_hemisphere(u));
    } else if ((rest -= chances.matt_on) < chances.mirrored) {
      rest /= chances.mirrored;
      wi = reflected_by(facets_back(look).sample(up, u), up);
      if (!(wi.z > 0)) return {};
    } else {
      if (!(chances.passed > 0)) return {};
      rest = (rest - chances.mirrored) / chances.passed;
      wi = beyond(reflected_by(facets_on(look).sample(up, u), up));
      if (!(wi.z < 0)) return {};
    }
    if (wi.z == 0) return {};
    if (wo.z < 0) wi = beyond(wi);
    const BsdfValues values = answer(context, look, wo, wi, lobes);
    return sample_with_event(wi, values.diffuse, values.glossy, values.pdf, wi.z * wo.z < 0,
                             std::clamp(rest, 0.0f, one_minus_epsilon));
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z == 0) return Spectrum();
    const ThinLook look = look_at(context);
    const Albedos albedos = albedos_of(context, look, raised(wo));
    Spectrum sum;
    if (any(lobes & Lobes::diffuse)) sum += albedos.matt_back + albedos.matt_on;
    if (any(lobes & Lobes::glossy)) sum += albedos.mirrored + albedos.passed;
    return sum * scale_of(context, look);
  }

 private:
  /// Directional albedos of the lobes.
  struct Albedos {
    Spectrum matt_back, matt_on, mirrored, passed;
  };
  /// With which sample() takes each.
  struct Chances {
    float matt_back = 0, matt_on = 0, mirrored = 0, passed = 0;
  };

  static bool may_be_pane(const ThinShares& shares, float eta) {
    if (shares.spec_trans.is_zero()) return false;
    return !shares.roughness.is_constant() || !shares.anisotropic.is_constant() ||
           kaustik::is_pane(shares.roughness.at({}), shares.anisotropic.at({}), eta);
  }
  /// Whether light goes straight on through its glassy part there.
  bool is_pane(const ThinLook& look) const {
    return look.spec_trans > 0 && kaustik::is_pane(look.roughness, look.anisotropic, eta_);
  }

  static SurfaceNeeds needs_of(const Texture& base_color, const ThinShares& shares) {
    SurfaceNeeds all = texture_needs({&base_color});
    for (const Share* share : shares.all()) all = all | texture_needs({share->texture()});
    return shares.anisotropic.is_zero() ? all : all | SurfaceNeeds::tangent;
  }

  ThinLook look_at(const BsdfContext& context) const {
    ThinLook look;
    look.roughness = shares_.roughness.at(context);
    look.anisotropic = shares_.anisotropic.at(context);
    look.spec_trans = shares_.spec_trans.at(context);
    look.spec_tint = shares_.spec_tint.at(context);
    look.sheen = shares_.sheen.at(context);
    look.sheen_tint = shares_.sheen_tint.at(context);
    look.flatness = shares_.flatness.at(context);
    look.onward = 0.5f * shares_.diff_trans.at(context);
    look.base = context.value_of(*base_color_);
    const float luminance = tint_luminance(context, look.base);
    look.tint = luminance > 0 ? look.base / luminance : white(context);
    return look;
  }
  /// Full reflection in every lane that carries light.
  static Spectrum white(const BsdfContext& context) {
    return lanes_from_reflectance(spectrum_from_rgb(1, 1, 1), context.wavelengths());
  }
  float tint_luminance(const BsdfContext& context, const Spectrum& base) const {
    if (shares_.spec_tint.is_zero() && shares_.sheen_tint.is_zero()) return 0;
    return context.wavelengths().is_rgb() ? luminance_of(base) : context.scalar_of(*base_color_);
  }
  Spectrum sheen_color(const BsdfContext& context, const ThinLook& look) const {
    return white(context) * look.sheen_color();
  }

  static MicrofacetDistribution facets_back(const ThinLook& look) {
    return burley_facets(look.roughness, look.anisotropic);
  }
  MicrofacetDistribution facets_on(const ThinLook& look) const {
    return burley_facets(sheet_roughness(look.roughness, eta_), look.anisotropic);
  }

  /// What a facet of the glassy part reflects.
  Spectrum mirrored_by(const BsdfContext& context, const ThinLook& look,
                       const DielectricFresnel& fresnel, float cos_facet) const {
    const Spectrum all = white(context);
    Spectrum share = all * ((1 - look.spec_tint) * fresnel.reflectance);
    if (look.spec_tint > 0) {
      const Spectrum normal = look.tint * normal_reflectance_;
      const float weight = schlick_weight(eta_ >= 1 ? cos_facet : fresnel.cos_transmitted);
      share += (normal + (all - normal) * weight) * look.spec_tint;
    }
    return share * look.spec_trans;
  }
  Spectrum passed_by(const ThinLook& look, float transmittance) const {
    return look.base * (look.spec_trans * transmittance);
  }

  /// Without the scale.
  Spectrum straight_of(const ThinLook& look, const Vec3f& up) const {
    if (!is_pane(look)) return Spectrum();
    return passed_by(look, 1 - fresnel_dielectric(up.z, eta_).reflectance);
  }

  BsdfValues answer(const BsdfContext& context, const ThinLook& look, const Vec3f& wo,
                    const Vec3f& wi, Lobes lobes) const {
    BsdfValues result;
    if (wo.z * wi.z == 0 || !any(lobes & traits().lobes)) return result;
    const bool is_through = wo.z * wi.z < 0;
    const bool has_gloss = any(lobes & Lobes::glossy) && look.spec_trans > 0;
    const bool is_matt = any(lobes & Lobes::diffuse);
    const Vec3f o = raised(wo), i = raised(wi);
    const Chances chances = chances_of(look, o, lobes), reverse = chances_of(look, i, lobes);
    if (has_gloss && !(is_through && is_pane(look))) {
      const FacetReflection facet =
          facet_reflection(is_through ? facets_on(look) : facets_back(look), o, i);
      if (facet.cos_facet != 0) {
        const DielectricFresnel fresnel = fresnel_dielectric(facet.cos_facet, eta_);
        result.glossy = (is_through ? passed_by(look, 1 - fresnel.reflectance)
                                    : mirrored_by(context, look, fresnel, facet.cos_facet)) *
                        facet.value;
        result.pdf = (is_through ? chances.passed : chances.mirrored) * facet.pdf;
        result.pdf_reverse = (is_through ? reverse.passed : reverse.mirrored) * facet.pdf_reverse;
      }
    }
    if (is_matt && is_through) {
      result.diffuse = look.base * (look.matt_on() * inv_pi);
    } else if (is_matt) {
      result.diffuse = look.base * (look.matt_back() * inv_pi *
                                    burley_base(o, i, look.roughness, look.flatness));
      if (look.sheen > 0) result.diffuse += sheen_color(context, look) * burley_sheen(o, i);
    }
    result.pdf += (is_through ? chances.matt_on : chances.matt_back) * cosine_hemisphere_pdf(i.z);
    result.pdf_reverse +=
        (is_through ? reverse.matt_on : reverse.matt_back) * cosine_hemisphere_pdf(o.z);
    const float scale = scale_of(context, look);
    result.diffuse *= scale;
    result.glossy *= scale;
    return result;
  }

  Albedos albedos_of(const BsdfContext& context, const ThinLook& look, const Vec3f& up) const {
    Albedos albedos;
    if (look.spec_trans > 0) {
      const AlbedoTables& tables = facet_albedos_->from_outside;
      const Spectrum back = tables(look.roughness, up),
                     on = tables(sheet_roughness(look.roughness, eta_), up);
      const Spectrum normal = look.tint * normal_reflectance_;
      albedos.mirrored =
          (white(context) * ((1 - look.spec_tint) * back[2]) +
           (normal * (back[0] - back[1]) + white(context) * back[1]) * look.spec_tint) *
          look.spec_trans;
      if (!is_pane(look)) albedos.passed = passed_by(look, on[0] - on[2]);
    }
    if (look.matt_back() > 0) {
      albedos.matt_back =
          look.base * (look.matt_back() * burley_base_albedo(up.z, look.roughness, look.flatness));
      if (look.sheen > 0)
        albedos.matt_back += sheen_color(context, look) * burley_sheen_albedo(up.z);
    }
    albedos.matt_on = look.base * look.matt_on();
    return albedos;
  }

  Chances chances_of(const ThinLook& look, const Vec3f& up, Lobes lobes) const {
    const Albedos albedos = albedos_of({}, look, up);
    Chances chances;
    if (any(lobes & Lobes::diffuse)) {
      chances.matt_back = albedos.matt_back.max_lane();
      chances.matt_on = albedos.matt_on.max_lane();
    }
    if (any(lobes & Lobes::glossy)) {
      chances.mirrored = albedos.mirrored.max_lane();
      chances.passed = albedos.passed.max_lane();
    }
    const float total = chances.matt_back + chances.matt_on + chances.mirrored + chances.passed;
    if (!(total > 0)) return {};
    return {chances.matt_back / total, chances.matt_on / total, chances.mirrored / total,
            chances.passed / total};
  }

  float scale_of_look(const ThinLook& look) const {
    const float most = most_reflected([&](const Vec3f& up) {
      const Albedos albedos = albedos_of({}, look, up);
      return albedos.matt_back + albedos.matt_on + albedos.mirrored + albedos.passed +
             straight_of(look, up);
    });
    return 1 / std::max(1.0f, most);
  }
  float scale_of(const BsdfContext& context, const ThinLook& look) const {
    if (constant_scale_ > 0) return constant_scale_;
    return context.number_of(this, [&] { return scale_of_look(look); });
  }

  std::shared_ptr<const Texture> base_color_;
  ThinShares shares_;
  float eta_;                 ///< n of the sheet over that beside it
  float normal_reflectance_;  ///< of its glassy part
  std::shared_ptr<const BurleyAlbedos> facet_albedos_;
  float constant_scale_ = 0;  ///< 0: it has to be found at each point
};

const TypeInfo& principledthin_info() {
  static const TypeInfo info{
      "bsdf",
      "principledthin",
      "Burley's (Disney's) thin sheet with two equal sides: leaves, paper, cloth, panes.",
      {color_parameter("base_color", 0.5, "Colour of the matt part and of transmitted light.")
           .range(0, 1)
           .textured(),
       share_parameter("roughness", 0.5, "Roughness. The slope of the facets is about its square."),
       share_parameter("anisotropic", 0, "Stretches highlights along the tangent."),
       share_parameter("spec_trans", 0, "Fraction of glass. The rest is matt."),
       number_parameter("eta", 1.5,
                        "Index of refraction of the sheet, relative to its surroundings.")
           .range(0.01, 100),
       share_parameter("spec_tint", 0, "Tint of the reflection of glass by the base colour."),
       share_parameter("sheen", 0, "Sheen of cloth at grazing angles."),
       share_parameter("sheen_tint", 0, "Tint of the sheen by the base colour."),
       share_parameter("flatness", 0, "Blends the base towards skin or wax."),
       number_parameter(
           "diff_trans", 0,
           "Twice the fraction of the matt part that is transmitted: 0 nothing, 2 all.")
           .range(0, 2)
           .clamped()
           .textured(),
       ignored_parameter("diffuse_reflectance_sampling_rate", ParameterKind::number),
       ignored_parameter("diffuse_transmittance_sampling_rate", ParameterKind::number),
       ignored_parameter("specular_reflectance_sampling_rate", ParameterKind::number),
       ignored_parameter("specular_transmittance_sampling_rate", ParameterKind::number)}};
  return info;
}

std::shared_ptr<const Bsdf> create_principledthin(const BsdfInputs& inputs) {
  const auto share = [&](std::string_view name) { return Share(inputs.texture(name)); };
  ThinShares shares{.roughness = share("roughness"),
                    .anisotropic = share("anisotropic"),
                    .spec_trans = share("spec_trans"),
                    .spec_tint = share("spec_tint"),
                    .sheen = share("sheen"),
                    .sheen_tint = share("sheen_tint"),
                    .flatness = share("flatness"),
                    .diff_trans = Share(inputs.texture("diff_trans"), 2)};
  return std::make_shared<PrincipledThin>(inputs.texture("base_color"), std::move(shares),
                                          float(inputs.arguments.number("eta")));
}

}  // namespace

BsdfType principledthin_type() { return {principledthin_info(), 0, 0, create_principledthin}; }

}  // namespace kaustik
