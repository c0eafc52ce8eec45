#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/lobe_event.h"
#include "kaustik/material/plastic_base.h"
#include "kaustik/material/rough_interface.h"

namespace kaustik {
namespace {

/// A matt base under a rough transparent coat; black from behind.
class RoughPlastic final : public Bsdf {
 public:
  using TexturePointer = std::shared_ptr<const Texture>;

  RoughPlastic(RoughFacets facets, const SpectralValue& interior, const SpectralValue& exterior,
               TexturePointer diffuse, bool nonlinear, TexturePointer specular)
      : Bsdf({.lobes = Lobes::diffuse | Lobes::glossy,
              .is_lambertian = false,
              .needs = facets.needs() | texture_needs({diffuse.get(), specular.get()})}),
        coat_(std::move(facets), interior, exterior),
        even_light_enters_(coat_.of_even_light().enters),
        base_(std::move(diffuse), nonlinear, interior.rgb()[0] / exterior.rgb()[0],
              coat_.of_even_light().reflected_inside),
        specular_(std::move(specular)) {}

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (wo.z <= 0 || wi.z <= 0) return Spectrum();
    Spectrum sum;
    if (any(lobes & Lobes::diffuse)) sum += scattered(context, wo, wi);
    if (any(lobes & Lobes::glossy)) sum += coat_.values(context, mirror(context), wo, wi).glossy;
    return sum;
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    if (!any(lobes & (Lobes::diffuse | Lobes::glossy)) || wo.z <= 0 || wi.z <= 0) return 0;
    return mixed(coat_chance(context, wo, lobes),
                 coat_.values(context, mirror(context), wo, wi).pdf, wi);
  }

  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    if (wo.z <= 0 || wi.z <= 0) return {};
    BsdfValues values = coat_.values(context, mirror(context), wo, wi);
    values.diffuse = scattered(context, wo, wi);
    values.pdf = mixed(coat_chance(context, wo, Lobes::all), values.pdf, wi);
    values.pdf_reverse = mixed(coat_chance(context, wi, Lobes::all), values.pdf_reverse, wo);
    return values;
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & (Lobes::diffuse | Lobes::glossy)) || wo.z <= 0) return {};
    const float chance = coat_chance(context, wo, lobes);
    Vec3f wi;
    float rest;
    if (u_lobe < chance) {
      rest = u_lobe / chance;
      const BsdfSample proposed = coat_.sample(context, mirror(context), wo, 0, u);
      if (proposed.event == Lobes::none) return {};
      wi = proposed.wi;
    } else {
      rest = (u_lobe - chance) / (1 - chance);
      wi = square_to_cosine_hemisphere(u);
      if (!(wi.z > 0)) return {};
    }
    const BsdfValues coat = coat_.values(context, mirror(context), wo, wi);
    return sample_with_event(wi,
                             any(lobes & Lobes::diffuse) ? scattered(context, wo, wi) : Spectrum(),
                             any(lobes & Lobes::glossy) ? coat.glossy : Spectrum(),
                             mixed(chance, coat.pdf, wi), false, std::min(rest, one_minus_epsilon));
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z <= 0) return Spectrum();
    const Parts parts = parts_at(context, wo);
    Spectrum sum;
    if (any(lobes & Lobes::glossy)) sum += parts.coat;
    if (any(lobes & Lobes::diffuse)) sum += parts.base;
    return sum;
  }

 private:
  /// Directional albedos.
  struct Parts {
    Spectrum coat, base;
  };
  Parts parts_at(const BsdfContext& context, const Vec3f& wo) const {
    const InterfaceAlbedo shares = coat_.albedo(context, wo);
    return {context.value_of(*specular_) * shares.reflected,
            base_.coupled_reflectance(context) * (shares.transmitted * even_light_enters_)};
  }
  /// Of what goes through the base knows.
  InterfaceFactors mirror(const BsdfContext& context) const {
    return {.reflectance = context.value_of(*specular_), .transmittance = {}};
  }
  Spectrum scattered(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const {
    return base_.coupled_reflectance(context) *
           (inv_pi * coat_.albedo(context, wo).transmitted * coat_.albedo(context, wi).transmitted);
  }
  /// With which sample() takes the coat, of the lobes asked for.
  float coat_chance(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const {
    if (!any(lobes & Lobes::glossy)) return 0;
    if (!any(lobes & Lobes::diffuse)) return 1;
    const Parts parts = parts_at(context, wo);
    const float coat = parts.coat.max_lane(), base = parts.base.max_lane();
    return coat + base > 0 ? coat / (coat + base) : 0.0f;
  }
  static float mixed(float chance, float pdf_of_coat, const Vec3f& wi) {
    return chance * pdf_of_coat + (1 - chance) * cosine_hemisphere_pdf(wi.z);
  }

  RoughInterface coat_;
  float even_light_enters_;
  PlasticBase base_;
  TexturePointer specular_;
};

TypeInfo make_roughplastic_info() {
  TypeInfo info{
      "bsdf",
      "roughplastic",
      "Matt base under a rough transparent coat; black seen from behind.",
      {distribution_parameter(),
       number_parameter("alpha", 0.1, "Roughness of the coat: about the root mean square slope.")
           .range(0, RoughFacets::largest_alpha)
           .clamped(),
       sample_visible_parameter()}};
  for (Parameter& parameter : plastic_parameters()) info.parameters.push_back(std::move(parameter));
  return info;
}

const TypeInfo& roughplastic_info() {
  static const TypeInfo info = make_roughplastic_info();
  return info;
}

std::shared_ptr<const Bsdf> make_roughplastic(const BsdfInputs& inputs,
                                              RoughFacets::TexturePointer alpha) {
  const Arguments& arguments = inputs.arguments;
  return std::make_shared<RoughPlastic>(
      RoughFacets(facet_kind_of(inputs), alpha, alpha), dielectric_ior_of(arguments, "int_ior"),
      dielectric_ior_of(arguments, "ext_ior"), inputs.texture("diffuse_reflectance"),
      arguments.boolean("nonlinear"), inputs.texture("specular_reflectance"));
}

std::shared_ptr<const Texture> constant_alpha(double alpha) {
  return make_constant_texture(SpectralValue(float(alpha)));
}

std::shared_ptr<const Bsdf> create_roughplastic(const BsdfInputs& inputs) {
  return make_roughplastic(inputs, constant_alpha(inputs.arguments.number("alpha")));
}

TypeInfo make_pplastic_info() {
  TypeInfo info = make_roughplastic_info();
  info.name = "pplastic";
  info.sentence = "Mitsuba's plastic for polarised light: 'roughplastic' here.";
  for (const char* name : {"alpha_u", "alpha_v"})
    info.parameters.push_back(
        optional(number_parameter(
                     name, 0.1,
                     "Roughness in one direction. The geometric mean of both directions is used."))
            .range(0, RoughFacets::largest_alpha)
            .clamped());
  return info;
}

const TypeInfo& pplastic_info() {
  static const TypeInfo info = make_pplastic_info();
  return info;
}

std::shared_ptr<const Bsdf> create_pplastic(const BsdfInputs& inputs) {
  inputs.warn("bsdf 'pplastic' is 'roughplastic' here: light is not polarised");
  const Arguments& arguments = inputs.arguments;
  double alpha = arguments.number("alpha");
  if (arguments.given("alpha_u") || arguments.given("alpha_v")) {
    const auto one = [&](std::string_view name) {
      return arguments.number(arguments.given(name) ? name : "alpha");
    };
    alpha = std::sqrt(one("alpha_u") * one("alpha_v"));
  }
  return make_roughplastic(inputs, constant_alpha(alpha));
}

}  // namespace

BsdfType roughplastic_type() { return {roughplastic_info(), 0, 0, create_roughplastic}; }
BsdfType pplastic_type() { return {pplastic_info(), 0, 0, create_pplastic}; }

}  // namespace kaustik
