#include <fmt/format.h>

#include <optional>

#include "kaustik/base/warp.h"
#include "kaustik/material/albedo_table.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/material/lobe_event.h"
#include "kaustik/material/rough_interface.h"

namespace kaustik {
namespace {

/// What the coat itself is made of.
struct CoatLayer {
  float eta = 1;           ///< n of the coat over that outside, where glasses are listed
  SpectralValue absorbed;  ///< extinction times thickness
  std::shared_ptr<const Texture> reflectance;
  std::optional<RoughInterface> rough;  ///< its surface; none: smooth
};

/// A transparent coat over another bsdf, which sees light refracted, and absorbed on its way; what
/// the coat throws back to it again is lost (Weidlich and Wilkie, "Arbitrarily Layered Micro-Facet
/// Surfaces", 2007; Mitsuba 0.6). Black from behind.
class Coating final : public Bsdf {
 public:
  Coating(std::shared_ptr<const Bsdf> nested, CoatLayer coat)
      : Bsdf({.lobes = nested->traits().lobes | (coat.rough ? Lobes::glossy : Lobes::delta),
              .is_lambertian = false,
              .needs = needs_of(nested->traits().needs, coat),
              .size = nested->traits().size + 1}),
        nested_(std::move(nested)),
        coat_(std::move(coat)),
        even_light_leaves_(leaving_share({})),
        gloss_leaves_(
            0, 0, !needs(nested_->traits().needs, SurfaceNeeds::tangent),
            [this](float, const Vec3f& wo, const Vec2f& u) { return leaving_gloss(wo, u); }) {}
  Coating(const Coating&) = delete;  // the tables refer to it
  Coating& operator=(const Coating&) = delete;

  const Relief* relief(bool front) const override { return nested_->relief(front); }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (wo.z <= 0 || wi.z <= 0) return Spectrum();
    const Inner inner = inner_of(context, wo, wi);
    Spectrum sum;
    if (inner.exists)
      sum = nested_->eval(context, inner.o, inner.i, lobes & Lobes::diffuse) * inner.factor +
            nested_->eval(context, inner.o, inner.i, lobes & Lobes::glossy) * inner.factor;
    if (any(lobes & Lobes::glossy) && coat_.rough)
      sum += coat_.rough->values(context, mirror(context), wo, wi).glossy;
    return sum;
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    if (!any(lobes & traits().lobes) || wo.z <= 0 || wi.z <= 0) return 0;
    const float chance = coat_chance(context, wo, lobes);
    const Inner inner = inner_of(context, wo, wi);
    float density = 0;
    if (inner.exists)
      density = (1 - chance) * inner.stretch * nested_->pdf(context, inner.o, inner.i, lobes);
    if (coat_.rough) density += chance * coat_.rough->values(context, mirror(context), wo, wi).pdf;
    return density;
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & traits().lobes) || wo.z <= 0) return {};
    const float chance = coat_chance(context, wo, lobes);
    const bool by_coat = u_lobe < chance;
    const float rest =
        std::min(by_coat ? u_lobe / chance : (u_lobe - chance) / (1 - chance), one_minus_epsilon);
    Vec3f wi;
    if (by_coat) {
      if (!coat_.rough)
        return {.wi = {-wo.x, -wo.y, wo.z},
                .weight = mirrored(context, wo) / chance,
                .pdf_solid_angle = chance,
                .event = Lobes::delta};
      const BsdfSample proposed = coat_.rough->sample(context, mirror(context), wo, 0, u);
      if (proposed.event == Lobes::none) return {};
      wi = proposed.wi;
    } else {
      const std::optional<Vec3f> o = into_coat(wo);
      if (!o) return {};
      const BsdfSample inside = nested_->sample(context, *o, rest, u, lobes);
      const std::optional<Vec3f> out =
          inside.event == Lobes::none ? std::nullopt : out_of_coat(inside.wi);
      if (!out) return {};
      wi = *out;
      if (inside.event == Lobes::delta) {
        BsdfSample sample = inside;
        sample.wi = wi;
        sample.weight *=
            passed(context, wo, *o) * passed(context, wi, inside.wi) * (1 / (1 - chance));
        sample.pdf_solid_angle *= 1 - chance;
        return sample;
      }
    }
    if (!(wi.z > 0)) return {};
    // What the choice of the lobe has left of `rest` are its lower digits.
    const float digits = rest * 4096 - std::floor(rest * 4096);
    return sample_with_event(wi, eval(context, wo, wi, lobes & Lobes::diffuse),
                             eval(context, wo, wi, lobes & Lobes::glossy),
                             pdf(context, wo, wi, lobes), false, digits);
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z <= 0) return Spectrum();
    Spectrum sum = nested_albedo(context, wo, lobes);
    if (any(lobes & own_lobe())) sum += mirrored(context, wo);
    return sum;
  }

 private:
  /// Both directions in the coat.
  struct Inner {
    bool exists = false;
    Vec3f o, i;
    Spectrum factor;    ///< f of the whole over that of what is nested
    float stretch = 0;  ///< solid angle in the coat over that outside, at wi
  };

  static SurfaceNeeds needs_of(SurfaceNeeds nested, const CoatLayer& coat) {
    const SurfaceNeeds all = nested | texture_needs({coat.reflectance.get()});
    return coat.rough ? all | coat.rough->needs() : all;
  }
  Lobes own_lobe() const { return coat_.rough ? Lobes::glossy : Lobes::delta; }

  // ---- ways through the surface of the coat ----

  std::optional<Vec3f> into_coat(const Vec3f& w) const { return refracted(w, 1 / coat_.eta); }
  std::optional<Vec3f> out_of_coat(const Vec3f& w) const { return refracted(w, coat_.eta); }
  static std::optional<Vec3f> refracted(const Vec3f& w, float scale) {
    const Vec3f along(w.x * scale, w.y * scale, 0);
    const float cos_sq = 1 - length_sq(along);
    if (!(cos_sq > 0) || !(w.z > 0)) return std::nullopt;
    return Vec3f(along.x, along.y, std::sqrt(cos_sq));
  }

  Inner inner_of(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const {
    const std::optional<Vec3f> o = into_coat(wo), i = into_coat(wi);
    if (!o || !i) return {};
    const float inverse_eta_sq = 1 / sqr(coat_.eta);
    return {true, *o, *i, passed(context, wo, *o) * passed(context, wi, *i) * inverse_eta_sq,
            inverse_eta_sq * wi.z / i->z};
  }
  /// Share of the light that passes between outside and the base.
  Spectrum passed(const BsdfContext& context, const Vec3f& outside, const Vec3f& inside) const {
    return remaining(context.wavelengths(), inside) * entering(context, outside);
  }
  float entering(const BsdfContext& context, const Vec3f& outside) const {
    return coat_.rough ? coat_.rough->albedo(context, outside).transmitted
                       : 1 - fresnel_dielectric(outside.z, coat_.eta).reflectance;
  }
  Spectrum remaining(const Wavelengths& wavelengths, const Vec3f& inside) const {
    return exp(coat_.absorbed.at(wavelengths) * (-1 / inside.z));
  }

  // ---- the coat's own reflection ----

  InterfaceFactors mirror(const BsdfContext& context) const {
    return {.reflectance = context.value_of(*coat_.reflectance), .transmittance = {}};
  }
  Spectrum mirrored(const BsdfContext& context, const Vec3f& wo) const {
    const float share = coat_.rough ? coat_.rough->albedo(context, wo).reflected
                                    : fresnel_dielectric(wo.z, coat_.eta).reflectance;
    return context.value_of(*coat_.reflectance) * share;
  }

  // ---- what comes out of what is nested ----

  /// Exact if that is Lambertian, for mirrors, and with a smooth coat; else good to some percent.
  Spectrum nested_albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const {
    const std::optional<Vec3f> o = into_coat(wo);
    if (!o) return Spectrum();
    Spectrum sum;
    if (any(lobes & Lobes::diffuse & nested_->traits().lobes))
      sum += nested_->albedo(context, *o, Lobes::diffuse) *
             (context.wavelengths().is_rgb() ? even_light_leaves_
                                             : leaving_share(context.wavelengths()));
    if (any(lobes & Lobes::glossy & nested_->traits().lobes)) {
      const Spectrum leaves = gloss_leaves_(0, wo);
      sum += nested_->albedo(context, *o, Lobes::glossy) * remaining(context.wavelengths(), *o) *
             // A texture may be black where the table was made.
             (leaves[1] > 0 ? leaves[0] / leaves[1] : entering(context, wo));
    }
    if (any(lobes & Lobes::delta & nested_->traits().lobes))
      sum += nested_->albedo(context, *o, Lobes::delta) * passed(context, wo, *o);
    return sum * passed(context, wo, *o);
  }
  /// Of even light that goes up in the coat.
  Spectrum leaving_share(const Wavelengths& wavelengths) const {
    constexpr int steps = 256;
    const BsdfContext context({}, TransportMode::radiance, wavelengths);
    Spectrum sum;
    for (int i = 0; i < steps; ++i) {
      const float cosine = (float(i) + 0.5f) / float(steps);
      const Vec3f outside(safe_sqrt(1 - cosine * cosine), 0, cosine);
      if (const std::optional<Vec3f> inside = into_coat(outside))
        sum += passed(context, outside, *inside) * cosine;
    }
    return sum * (2 / (float(steps) * sqr(coat_.eta)));
  }
  /// Lane 0: what leaves of the light that lane 1 has, without absorption.
  Spectrum leaving_gloss(const Vec3f& wo, const Vec2f& u) const {
    const std::optional<Vec3f> o = into_coat(wo);
    if (!o) return Spectrum();
    const BsdfSample s =
        nested_->sample({}, *o, u.x, {u.y, 4096 * u.x - std::floor(4096 * u.x)}, Lobes::glossy);
    if (s.event == Lobes::none) return Spectrum();
    const float weight = s.weight.sum();
    const std::optional<Vec3f> out = out_of_coat(s.wi);
    return {out ? weight * entering({}, *out) : 0.0f, weight, 0, 0};
  }

  /// With which sample() takes the coat, of the lobes asked for.
  float coat_chance(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const {
    if (!any(lobes & own_lobe())) return 0;
    const float coat = mirrored(context, wo).max_lane(),
                nested = nested_albedo(context, wo, lobes).max_lane();
    return coat + nested > 0 ? coat / (coat + nested) : 0.0f;
  }

  std::shared_ptr<const Bsdf> nested_;
  CoatLayer coat_;
  Spectrum even_light_leaves_;  ///< in RGB mode
  AlbedoTables gloss_leaves_;
};

TypeInfo make_coating_info(const std::string& name, const std::string& sentence) {
  TypeInfo info{"bsdf", name, sentence, dielectric_ior_parameters()};
  info.parameters.push_back(
      number_parameter("thickness", 1, "Thickness of the coat, in the length unit of sigma_a.")
          .range(0, 1e9));
  info.parameters.push_back(
      color_parameter("sigma_a", 0, "Absorption of the coat.").in("1/m").range(0, 1e9));
  info.parameters.push_back(specular_reflectance_parameter());
  return info;
}

const TypeInfo& coating_info() {
  static const TypeInfo info = make_coating_info(
      "coating", "Smooth transparent coat over a nested bsdf; black seen from behind.");
  return info;
}
const TypeInfo& roughcoating_info() {
  static const TypeInfo info = [] {
    TypeInfo rough = make_coating_info(
        "roughcoating", "Rough transparent coat over a nested bsdf; black seen from behind.");
    rough.parameters.push_back(distribution_parameter());
    rough.parameters.push_back(alpha_parameter("alpha", "Roughness of the coat."));
    rough.parameters.push_back(sample_visible_parameter());
    return rough;
  }();
  return info;
}

std::shared_ptr<const Bsdf> make_coating(const BsdfInputs& inputs, bool is_rough) {
  const Arguments& arguments = inputs.arguments;
  if (inputs.nested.front()->traits().transmits) {
    const std::string fault =
        fmt::format("bsdf '{}' holds one that transmits light", arguments.info().name);
    if (inputs.is_strict)
      throw Error(ErrorKind::input, fault,
                  "put the coat around a bsdf that reflects, such as diffuse or conductor",
                  arguments.place());
    inputs.warn(fault + ": it has no coat");
    return inputs.nested.front();
  }
  const SpectralValue interior = dielectric_ior_of(arguments, "int_ior"),
                      exterior = dielectric_ior_of(arguments, "ext_ior");
  CoatLayer coat{.eta = interior.rgb()[0] / exterior.rgb()[0],
                 .absorbed = SpectralValue::reflectance(arguments.color("sigma_a")) *
                             float(arguments.number("thickness")),
                 .reflectance = inputs.texture("specular_reflectance"),
                 .rough = std::nullopt};
  if (is_rough) {
    const auto alpha = inputs.texture("alpha");
    coat.rough.emplace(RoughFacets(facet_kind_of(inputs), alpha, alpha), interior, exterior);
  }
  return std::make_shared<Coating>(inputs.nested.front(), std::move(coat));
}

std::shared_ptr<const Bsdf> create_coating(const BsdfInputs& inputs) {
  return make_coating(inputs, false);
}
std::shared_ptr<const Bsdf> create_roughcoating(const BsdfInputs& inputs) {
  return make_coating(inputs, true);
}

}  // namespace

BsdfType coating_type() { return {coating_info(), 1, 1, create_coating}; }
BsdfType roughcoating_type() { return {roughcoating_info(), 1, 1, create_roughcoating}; }

}  // namespace kaustik
