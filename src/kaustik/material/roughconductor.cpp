#include "kaustik/material/albedo_table.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/conductor_arguments.h"
#include "kaustik/material/microfacet.h"

namespace kaustik {
namespace {

/// Rough metal after Torrance and Sparrow with Walter et al.'s distributions; black from behind.
class RoughConductor final : public Bsdf {
 public:
  RoughConductor(const MicrofacetDistribution& facets, const ComplexIor& ior,
                 std::shared_ptr<const Texture> reflectance)
      : facets_(facets),
        ior_(ior),
        reflectance_(std::move(reflectance)),
        albedo_(facets.is_isotropic(),
                [this](const Vec3f& wo, const Vec2f& u) { return sample_lobe(wo, u).weight; }) {}

  Lobes lobes() const override { return Lobes::glossy; }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0 || wi.z <= 0) return Spectrum();
    const Vec3f m = normalize(wo + wi);
    const float geometry = facets_.density(m) * facets_.masking(wo) * facets_.masking(wi);
    return reflectance_->eval(context.texture) * fresnel(wo, m) * (geometry / (4 * wo.z * wi.z));
  }

  float pdf(const BsdfContext&, const Vec3f& wo, const Vec3f& wi, Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0 || wi.z <= 0) return 0;
    return pdf_of_reflection(wo, normalize(wo + wi));
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0) return {};
    BsdfSample sample = sample_lobe(wo, u);
    sample.weight *= reflectance_->eval(context.texture);
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0) return Spectrum();
    return reflectance_->eval(context.texture) * albedo_(wo);
  }

 private:
  Spectrum fresnel(const Vec3f& wo, const Vec3f& m) const {
    return fresnel_conductor(std::clamp(dot(wo, m), 0.0f, 1.0f), ior_);
  }

  float pdf_of_reflection(const Vec3f& wo, const Vec3f& m) const {
    const float cos_facet = dot(wo, m);
    return cos_facet > 0 ? facets_.pdf(wo, m) / (4 * cos_facet) : 0.0f;
  }

  /// Without the texture. Light that a facet sends below the horizon is lost.
  BsdfSample sample_lobe(const Vec3f& wo, const Vec2f& u) const {
    BsdfSample sample;
    const Vec3f m = facets_.sample(wo, u);
    sample.wi = reflect(wo, m);
    sample.pdf_solid_angle = pdf_of_reflection(wo, m);
    if (sample.wi.z <= 0 || !(sample.pdf_solid_angle > 0)) return {};
    // f·cosθ_i/pdf; D cancels.
    const float cos_facet = dot(wo, m);
    const float hidden = facets_.masking(wo) * facets_.masking(sample.wi) * facets_.density(m);
    sample.weight = fresnel(wo, m) * (hidden * cos_facet / (wo.z * facets_.pdf(wo, m)));
    sample.event = Lobes::glossy;
    return sample;
  }

  MicrofacetDistribution facets_;
  ComplexIor ior_;
  std::shared_ptr<const Texture> reflectance_;
  AlbedoTable albedo_;
};

constexpr double least_alpha = 1e-3, largest_alpha = 10;

TypeInfo make_info() {
  TypeInfo info{
      "bsdf",
      "roughconductor",
      "Rough metal; black seen from behind, see 'twosided'.",
      {choice_parameter("distribution", "beckmann", {"beckmann", "ggx"},
                        "Distribution of the normals of the microscopic facets."),
       number_parameter("alpha", 0.1, "Roughness; about the root mean square slope of the facets.")
           .range(least_alpha, largest_alpha),
       optional(number_parameter("alpha_u", 0.1, "Roughness along the tangent, instead of alpha."))
           .range(least_alpha, largest_alpha),
       optional(number_parameter("alpha_v", 0.1, "Roughness across the tangent, instead of alpha."))
           .range(least_alpha, largest_alpha),
       boolean_parameter("sample_visible", true,
                         "Sample only facets that can be seen: less noise, same result.")}};
  for (Parameter& parameter : conductor_parameters())
    info.parameters.push_back(std::move(parameter));
  return info;
}

const TypeInfo& info() {
  static const TypeInfo info = make_info();
  return info;
}

struct Roughness {
  float x, y;
};
Roughness roughness(const Arguments& arguments) {
  const bool has_u = arguments.given("alpha_u"), has_v = arguments.given("alpha_v");
  if (!has_u && !has_v) {
    const float alpha = float(arguments.number("alpha"));
    return {alpha, alpha};
  }
  if (arguments.given("alpha"))
    throw Error(ErrorKind::input, "'alpha' is given together with 'alpha_u' or 'alpha_v'",
                "keep alpha or both of the others", arguments.place_of("alpha"));
  if (!has_u || !has_v)
    throw Error(
        ErrorKind::input,
        has_u ? "'alpha_u' is given without 'alpha_v'" : "'alpha_v' is given without 'alpha_u'",
        "give both, or alpha alone", arguments.place_of(has_u ? "alpha_u" : "alpha_v"));
  return {float(arguments.number("alpha_u")), float(arguments.number("alpha_v"))};
}

std::shared_ptr<const Bsdf> create(const BsdfInputs& inputs) {
  using Kind = MicrofacetDistribution::Kind;
  const Arguments& arguments = inputs.arguments;
  const Kind kind = arguments.text("distribution") == "ggx" ? Kind::ggx : Kind::beckmann;
  const Roughness alpha = roughness(arguments);
  const MicrofacetDistribution facets(kind, alpha.x, alpha.y, arguments.boolean("sample_visible"));
  return std::make_shared<RoughConductor>(facets, conductor_ior(arguments),
                                          inputs.texture("specular_reflectance"));
}

}  // namespace

BsdfType roughconductor_type() { return {info(), 0, 0, create}; }

}  // namespace kaustik
