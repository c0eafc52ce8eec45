#include <array>

#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/burley_diffuse.h"
#include "kaustik/material/burley_facets.h"
#include "kaustik/material/clearcoat.h"
#include "kaustik/material/facet_scattering.h"
#include "kaustik/material/lobe_event.h"
#include "kaustik/material/most_reflected.h"
#include "kaustik/material/schlick.h"
#include "kaustik/material/share.h"

namespace kaustik {
namespace {

using TexturePointer = std::shared_ptr<const Texture>;

struct PrincipledShares {
  Share roughness, anisotropic, metallic, spec_trans, spec_tint, sheen, sheen_tint, flatness,
      clearcoat, clearcoat_gloss;

  std::array<const Share*, 10> all() const {
    return {&roughness, &anisotropic, &metallic, &spec_trans, &spec_tint,
            &sheen,     &sheen_tint,  &flatness, &clearcoat,  &clearcoat_gloss};
  }
};

/// All that the parameters say of one point.
struct Look {
  Spectrum base, tint;  ///< the colour, and the same at a luminance of 1
  float roughness = 0, anisotropic = 0, metallic = 0, spec_trans = 0, spec_tint = 0, sheen = 0,
        sheen_tint = 0, flatness = 0, clearcoat = 0, clearcoat_gloss = 0;

  /// Of what scatters beneath the surface, and of what goes through.
  float matt() const { return (1 - metallic) * (1 - spec_trans); }
  float clear() const { return (1 - metallic) * spec_trans; }
  Spectrum sheen_color() const {
    return (Spectrum(1 - sheen_tint) + tint * sheen_tint) * (sheen * (1 - metallic));
  }
};

/// Burley's model with all its lobes, as in Mitsuba: a matt base with sheen, a facetted surface
/// that is glass, metal or between, and a clear coat. From behind only what is of glass is seen.
/// Where the lobes together would reflect more light than arrives, all of them are scaled down.
class Principled final : public Bsdf {
 public:
  Principled(TexturePointer base_color, PrincipledShares shares, float eta)
      : Bsdf({.lobes = Lobes::diffuse | Lobes::glossy,
              .transmits = !shares.spec_trans.is_zero(),
              .is_lambertian = false,
              .needs = needs_of(*base_color, shares)}),
        base_color_(std::move(base_color)),
        shares_(std::move(shares)),
        eta_(eta),
        normal_reflectance_(sqr((eta - 1) / (eta + 1))),
        facet_albedos_(burley_albedos(eta, shares_.anisotropic.mean())),
        coat_albedos_(clearcoat_albedos(eta)) {
    find_scale();
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
  void all_values(const BsdfContext& context, const Vec3f& wo, std::span<Vec3f> wi,
                  std::span<BsdfValues> result) const override {
    const Look look = look_at(context);
    for (size_t i = 0; i < wi.size(); ++i) result[i] = answer(context, look, wo, wi[i], Lobes::all);
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (wo.z == 0) return {};
    const Look look = look_at(context);
    const Chances chances = chances_of(look, wo, lobes);
    Vec3f wi;
    float eta = 1;
    float rest = u_lobe;
    if (rest < chances.matt) {
      rest /= chances.matt;
      wi = square_to_cosine_hemisphere(u);
    } else if ((rest -= chances.matt) < chances.coat) {
      rest /= chances.coat;
      wi = Clearcoat(look.clearcoat_gloss, eta_).sample(wo, u);
    } else {
      if (!(chances.facets > 0)) return {};
      rest = std::min((rest - chances.coat) / chances.facets, one_minus_epsilon);
      const Vec3f m = sample_facet(burley_facets(look.roughness, look.anisotropic), wo, u);
      const float cos_facet = dot(wo, m);
      if (!(cos_facet * wo.z > 0)) return {};
      const DielectricFresnel fresnel = fresnel_dielectric(cos_facet, eta_);
      const float back = 1 - chance_through(look, wo, cos_facet, fresnel, 1 - fresnel.reflectance);
      if (rest < back) {
        rest /= back;
        wi = reflected_by(m, wo);
        if (!(wi.z * wo.z > 0)) return {};
      } else {
        rest = (rest - back) / (1 - back);
        wi = refracted_by(m, wo, fresnel);
        eta = fresnel.eta;
        if (!(wi.z * wo.z < 0)) return {};
      }
    }
    if (wi.z == 0 || (eta == 1 && !(wi.z * wo.z > 0))) return {};
    const BsdfValues values = answer(context, look, wo, wi, lobes);
    BsdfSample sample = sample_with_event(wi, values.diffuse, values.glossy, values.pdf,
                                          wi.z * wo.z < 0, std::min(rest, one_minus_epsilon));
    sample.eta = eta;
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z == 0) return Spectrum();
    const Look look = look_at(context);
    const Albedos albedos = albedos_of(context, look, wo);
    Spectrum sum;
    if (any(lobes & Lobes::diffuse)) sum += albedos.matt;
    if (any(lobes & Lobes::glossy)) sum += albedos.reflected + albedos.transmitted + albedos.coat;
    return sum * scale_of(context, look);
  }

 private:
  /// Directional albedos of the lobes.
  struct Albedos {
    Spectrum matt, reflected, transmitted, coat;
  };
  /// With which sample() takes each.
  struct Chances {
    float matt = 0, coat = 0, facets = 0;
  };

  static SurfaceNeeds needs_of(const Texture& base_color, const PrincipledShares& shares) {
    SurfaceNeeds all = texture_needs({&base_color});
    for (const Share* share : shares.all()) all = all | texture_needs({share->texture()});
    return shares.anisotropic.is_zero() ? all : all | SurfaceNeeds::tangent;
  }

  Look look_at(const BsdfContext& context) const {
    Look look = shares_at(context);
    look.base = context.value_of(*base_color_);
    const float luminance = tint_luminance(context, look.base);
    look.tint = luminance > 0 ? look.base / luminance : white(context);
    return look;
  }
  Look shares_at(const BsdfContext& context) const {
    Look look;
    look.roughness = shares_.roughness.at(context);
    look.anisotropic = shares_.anisotropic.at(context);
    look.metallic = shares_.metallic.at(context);
    look.spec_trans = shares_.spec_trans.at(context);
    look.spec_tint = shares_.spec_tint.at(context);
    look.sheen = shares_.sheen.at(context);
    look.sheen_tint = shares_.sheen_tint.at(context);
    look.flatness = shares_.flatness.at(context);
    look.clearcoat = shares_.clearcoat.at(context);
    look.clearcoat_gloss = shares_.clearcoat_gloss.at(context);
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

  /// What a facet reflects; from outside that of glass, of metal and of glass with a tint mixed.
  Spectrum fresnel_of(const BsdfContext& context, const Look& look, const Vec3f& wo,
                      float cos_facet, const DielectricFresnel& fresnel) const {
    const Spectrum all = white(context);
    if (wo.z < 0) return all * (look.clear() * fresnel.reflectance);
    const float weight = schlick_weight(eta_ >= 1 ? cos_facet : fresnel.cos_transmitted);
    const auto schlick = [&](const Spectrum& normal) { return normal + (all - normal) * weight; };
    Spectrum sum = all * ((1 - look.metallic) * (1 - look.spec_tint) * fresnel.reflectance);
    if (look.metallic > 0) sum += schlick(look.base) * look.metallic;
    if (look.spec_tint > 0)
      sum += schlick(look.tint * normal_reflectance_) * ((1 - look.metallic) * look.spec_tint);
    return sum;
  }
  /// What a facet lets through, for flux.
  static Spectrum through(const Look& look, float transmittance) {
    return sqrt(look.base) * (look.clear() * transmittance);
  }
  /// Chance with which a facet that was chosen transmits.
  float chance_through(const Look& look, const Vec3f& wo, float cos_facet,
                       const DielectricFresnel& fresnel, float transmittance) const {
    const float back = fresnel_of({}, look, wo, cos_facet, fresnel).max_lane();
    const float on = through(look, transmittance).max_lane();
    return back + on > 0 ? on / (back + on) : 0.0f;
  }

  BsdfValues answer(const BsdfContext& context, const Look& look, const Vec3f& wo, const Vec3f& wi,
                    Lobes lobes) const {
    BsdfValues result;
    if (wo.z * wi.z == 0 || !any(lobes & traits().lobes)) return result;
    const bool is_front = wo.z > 0, is_through = wo.z * wi.z < 0;
    if ((!is_front || is_through) && !(look.clear() > 0)) return result;
    const bool has_gloss = any(lobes & Lobes::glossy);
    const Chances chances = chances_of(look, wo, lobes), reverse = chances_of(look, wi, lobes);
    const MicrofacetDistribution facets = burley_facets(look.roughness, look.anisotropic);
    if (is_through) {
      if (!has_gloss) return result;
      const double ratio = eta_, eta = is_front ? ratio : 1 / ratio;
      const FacetRefraction facet = facet_refraction(facets, wo, wi, eta);
      if (facet.cos_facet == 0) return result;
      result.glossy = through(look, facet.transmittance) * facet.value;
      if (context.mode == TransportMode::flux) result.glossy *= float(sqr(eta));
      const auto density = [&](const Vec3f& from, float cos_facet, float cos_other, double ratio_on,
                               float facets_share, float pdf) {
        const DielectricFresnel fresnel{.reflectance = 1 - facet.transmittance,
                                        .cos_transmitted = std::fabs(cos_other),
                                        .eta = float(ratio_on)};
        return facets_share * pdf *
               chance_through(look, from, cos_facet, fresnel, facet.transmittance);
      };
      result.pdf = density(wo, facet.cos_facet, facet.cos_other, eta, chances.facets, facet.pdf);
      result.pdf_reverse =
          density(wi, facet.cos_other, facet.cos_facet, 1 / eta, reverse.facets, facet.pdf_reverse);
    } else {
      const FacetReflection facet = facet_reflection(facets, wo, wi);
      if (facet.cos_facet != 0) {
        const DielectricFresnel fresnel = fresnel_dielectric(facet.cos_facet, eta_);
        const float back =
            1 - chance_through(look, wo, facet.cos_facet, fresnel, 1 - fresnel.reflectance);
        if (has_gloss)
          result.glossy = fresnel_of(context, look, wo, facet.cos_facet, fresnel) * facet.value;
        result.pdf = chances.facets * back * facet.pdf;
        result.pdf_reverse = reverse.facets * back * facet.pdf_reverse;
      }
      if (is_front) add_front_lobes(context, look, wo, wi, lobes, chances, reverse, result);
    }
    const float scale = scale_of(context, look);
    result.diffuse *= scale;
    result.glossy *= scale;
    return result;
  }

  /// Base, sheen and coat.
  void add_front_lobes(const BsdfContext& context, const Look& look, const Vec3f& wo,
                       const Vec3f& wi, Lobes lobes, const Chances& chances, const Chances& reverse,
                       BsdfValues& result) const {
    if (any(lobes & Lobes::diffuse)) {
      if (look.matt() > 0)
        result.diffuse +=
            look.base * (look.matt() * inv_pi * burley_base(wo, wi, look.roughness, look.flatness));
      if (look.sheen > 0) result.diffuse += sheen_color(context, look) * burley_sheen(wo, wi);
    }
    result.pdf += chances.matt * cosine_hemisphere_pdf(wi.z);
    result.pdf_reverse += reverse.matt * cosine_hemisphere_pdf(wo.z);
    if (!(look.clearcoat > 0) || !any(lobes & Lobes::glossy)) return;
    const Clearcoat coat(look.clearcoat_gloss, eta_);
    result.glossy += white(context) * (look.clearcoat * coat.eval(wo, wi));
    const float density = coat.pdf(wo, wi);  // the same both ways
    result.pdf += chances.coat * density;
    result.pdf_reverse += reverse.coat * density;
  }
  static Spectrum sheen_color(const BsdfContext& context, const Look& look) {
    return white(context) * look.sheen_color();
  }

  Albedos albedos_of(const BsdfContext& context, const Look& look, const Vec3f& wo) const {
    Albedos albedos;
    const bool is_front = wo.z > 0;
    if (!is_front && !(look.clear() > 0)) return albedos;
    const Vec3f up = is_front ? wo : -wo;
    const Spectrum facets =
        (is_front ? facet_albedos_->from_outside : facet_albedos_->from_inside)(look.roughness, up);
    const float whole = facets[0], grazing = facets[1], glass = facets[2], through = facets[3];
    albedos.transmitted = sqrt(look.base) * (look.clear() * through);
    if (!is_front) {
      albedos.reflected = white(context) * (look.clear() * glass);
      return albedos;
    }
    const auto schlick = [&](const Spectrum& normal) {
      return normal * (whole - grazing) + white(context) * grazing;
    };
    albedos.reflected =
        white(context) * ((1 - look.metallic) * (1 - look.spec_tint) * glass) +
        schlick(look.base) * look.metallic +
        schlick(look.tint * normal_reflectance_) * ((1 - look.metallic) * look.spec_tint);
    if (look.matt() > 0)
      albedos.matt +=
          look.base * (look.matt() * burley_base_albedo(wo.z, look.roughness, look.flatness));
    if (look.sheen > 0) albedos.matt += sheen_color(context, look) * burley_sheen_albedo(wo.z);
    if (look.clearcoat > 0)
      albedos.coat =
          white(context) * (look.clearcoat * (*coat_albedos_)(look.clearcoat_gloss, wo)[0]);
    return albedos;
  }

  Chances chances_of(const Look& look, const Vec3f& wo, Lobes lobes) const {
    const Albedos albedos = albedos_of({}, look, wo);
    Chances chances;
    if (any(lobes & Lobes::diffuse)) chances.matt = albedos.matt.max_lane();
    if (any(lobes & Lobes::glossy)) {
      chances.coat = albedos.coat.max_lane();
      chances.facets = (albedos.reflected + albedos.transmitted).max_lane();
    }
    const float total = chances.matt + chances.coat + chances.facets;
    if (!(total > 0)) return {};
    return {chances.matt / total, chances.coat / total, chances.facets / total};
  }

  float most_reflected_by(const Look& look) const {
    return most_reflected([&](const Vec3f& wo) {
      const Albedos albedos = albedos_of({}, look, wo);
      return albedos.matt + albedos.reflected + albedos.transmitted + albedos.coat;
    });
  }
  /// Of all lobes, so that no more is reflected than arrives.
  float scale_of(const BsdfContext& context, const Look& look) const {
    if (constant_scale_ > 0) return constant_scale_;
    return context.number_of(this, [&] { return 1 / std::max(1.0f, most_reflected_by(look)); });
  }
  /// Sets constant_scale_ where it is the same everywhere: all parameters are constant, or the most
  /// that textures may say is no more than arrives. Albedos are linear in metallic, spec_trans,
  /// spec_tint, sheen_tint and flatness, and rise with the colour.
  void find_scale() {
    const bool has_tint = !shares_.spec_tint.is_zero() || !shares_.sheen_tint.is_zero();
    bool is_constant = base_color_->is_constant();
    for (const Share* share : shares_.all()) is_constant = is_constant && share->is_constant();
    Look look = look_at({});
    if (is_constant) {
      constant_scale_ = 1 / std::max(1.0f, most_reflected_by(look));
      return;
    }
    if (!base_color_->is_constant()) {
      if (has_tint) return;  // tints may be of any colour
      look.base = white({}) * std::min(1.0f, base_color_->maximum());
    }
    look.sheen = shares_.sheen.extremes(1).back();
    look.clearcoat = shares_.clearcoat.extremes(1).back();
    for (const float roughness : shares_.roughness.extremes(4))
      for (const float metallic : shares_.metallic.extremes(1))
        for (const float spec_trans : shares_.spec_trans.extremes(1))
          for (const float spec_tint : shares_.spec_tint.extremes(1))
            for (const float sheen_tint : shares_.sheen_tint.extremes(1))
              for (const float flatness : shares_.flatness.extremes(1))
                for (const float gloss : shares_.clearcoat_gloss.extremes(1)) {
                  look.roughness = roughness;
                  look.metallic = metallic;
                  look.spec_trans = spec_trans;
                  look.spec_tint = spec_tint;
                  look.sheen_tint = sheen_tint;
                  look.flatness = flatness;
                  look.clearcoat_gloss = gloss;
                  if (most_reflected_by(look) > 1) return;
                }
    constant_scale_ = 1;
  }

  TexturePointer base_color_;
  PrincipledShares shares_;
  float eta_;                 ///< n_interior/n_exterior
  float normal_reflectance_;  ///< of glass
  std::shared_ptr<const BurleyAlbedos> facet_albedos_;
  std::shared_ptr<const AlbedoTables> coat_albedos_;
  float constant_scale_ = 0;  ///< 0: it has to be found at each point
};

/// Of glass with an index of refraction near 100.
constexpr double largest_specular = 12;

const TypeInfo& principled_info() {
  static const TypeInfo info{
      "bsdf",
      "principled",
      "Burley's (Disney's) model for most surfaces: matt, cloth, plastic, metal, glass, varnish.",
      {color_parameter("base_color", 0.5, "Colour of the base, of metal and of clear glass.")
           .range(0, 1)
           .textured(),
       share_parameter("roughness", 0.5, "Roughness. The slope of the facets is about its square."),
       share_parameter("anisotropic", 0, "Stretches highlights along the tangent."),
       share_parameter("metallic", 0, "Fraction of metal. The rest is matt or glass."),
       share_parameter("spec_trans", 0, "Fraction of glass in the non-metal part."),
       optional(number_parameter("eta", 1.5, "Index of refraction inside, relative to outside."))
           .range(0.01, 100),
       optional(number_parameter(
                    "specular", 0.5,
                    "Reflectance of glass at normal incidence divided by 0.08, instead of eta."))
           .range(0, largest_specular)
           .clamped()
           .instead_of("eta"),
       share_parameter("spec_tint", 0, "Tint of the reflection of glass by the base colour."),
       share_parameter("sheen", 0, "Sheen of cloth at grazing angles."),
       share_parameter("sheen_tint", 0, "Tint of the sheen by the base colour."),
       share_parameter("flatness", 0, "Blends the base towards skin or wax."),
       share_parameter("clearcoat", 0, "Weight of the coat of varnish."),
       share_parameter("clearcoat_gloss", 0, "Gloss of the coat."),
       ignored_parameter("main_specular_sampling_rate", ParameterKind::number),
       ignored_parameter("clearcoat_sampling_rate", ParameterKind::number),
       ignored_parameter("diffuse_reflectance_sampling_rate", ParameterKind::number)}};
  return info;
}

/// As in Mitsuba an index of 1 is one near to it where there is glass.
float eta_of(const Arguments& arguments, bool has_glass) {
  if (arguments.given("eta")) {
    const auto eta = float(arguments.number("eta"));
    return has_glass && eta == 1 ? 1.001f : eta;
  }
  double specular = arguments.given("specular") ? arguments.number("specular") : 0.5;
  if (has_glass && specular == 0) specular = 1e-3;
  return float(2 / (1 - std::sqrt(0.08 * specular)) - 1);
}

std::shared_ptr<const Bsdf> create_principled(const BsdfInputs& inputs) {
  const auto share = [&](std::string_view name) { return Share(inputs.texture(name)); };
  PrincipledShares shares{.roughness = share("roughness"),
                          .anisotropic = share("anisotropic"),
                          .metallic = share("metallic"),
                          .spec_trans = share("spec_trans"),
                          .spec_tint = share("spec_tint"),
                          .sheen = share("sheen"),
                          .sheen_tint = share("sheen_tint"),
                          .flatness = share("flatness"),
                          .clearcoat = share("clearcoat"),
                          .clearcoat_gloss = share("clearcoat_gloss")};
  const float eta = eta_of(inputs.arguments, !shares.spec_trans.is_zero());
  return std::make_shared<Principled>(inputs.texture("base_color"), std::move(shares), eta);
}

}  // namespace

BsdfType principled_type() { return {principled_info(), 0, 0, create_principled}; }

}  // namespace kaustik
