#include "kaustik/material/albedo_table.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/conductor_arguments.h"
#include "kaustik/material/rough_facets.h"
#include "kaustik/material/schlick.h"

namespace kaustik {
namespace {

/// Rough metal after Torrance and Sparrow with Walter et al.'s distributions; black from behind.
class RoughConductor final : public Bsdf {
 public:
  RoughConductor(RoughFacets facets, MetalFresnel metal, std::shared_ptr<const Texture> reflectance)
      : Bsdf({.lobes = Lobes::glossy,
              .needs = facets.needs() | metal.needs() | texture_needs({reflectance.get()})}),
        facets_(std::move(facets)),
        metal_(std::move(metal)),
        reflectance_(std::move(reflectance)),
        albedo_(albedo_tables(
            [this](float cos_facet) { return fresnel_conductor(cos_facet, metal_.at({})); })),
        means_(albedo_tables([](float cos_facet) {
          return Spectrum(1, schlick_weight(cos_facet), lazanyi_weight(cos_facet), 0);
        })) {}

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0 || wi.z <= 0) return Spectrum();
    const Vec3f m = normalize(wo + wi);
    const MicrofacetDistribution facets = facets_.at(context);
    return value_of(context, wo, wi, m,
                    facets.density(m) * facets.masking(wo) * facets.masking(wi));
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0 || wi.z <= 0) return 0;
    const Vec3f m = normalize(wo + wi);
    return pdf_of_reflection(facets_.at(context).pdf(wo, m), dot(wo, m));
  }

  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    if (wo.z <= 0 || wi.z <= 0) return {};
    const Vec3f m = normalize(wo + wi);
    const MicrofacetDistribution facets = facets_.at(context);
    const float density = facets.density(m);
    const float seen = facets.masking(wo), lit = facets.masking(wi);
    return {{},
            value_of(context, wo, wi, m, density * seen * lit),
            pdf_of_reflection(facets.pdf(wo, m, density, seen), dot(wo, m)),
            pdf_of_reflection(facets.pdf(wi, m, density, lit), dot(wi, m))};
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0) return {};
    BsdfSample sample = sample_lobe(facets_.at(context), wo, u, [&](float cos_facet) {
      return fresnel_conductor(cos_facet, metal_.at(context));
    });
    sample.weight *= context.value_of(*reflectance_);
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0) return Spectrum();
    const float log_alpha = facets_.log_alpha(context);
    if (context.wavelengths().is_rgb() && metal_.is_constant())
      return context.value_of(*reflectance_) * albedo_(log_alpha, wo);
    // There are no tables of every wavelength, nor of every colour.
    const ComplexIor ior = metal_.at(context);
    const Spectrum means = means_(log_alpha, wo);
    const LazanyiMetal metal = LazanyiMetal::through(fresnel_conductor(1, ior), Spectrum(1),
                                                     fresnel_conductor(lazanyi_cosine, ior));
    return context.value_of(*reflectance_) * metal.reflectance(means[0], means[1], means[2]);
  }

 private:
  static float cosine_to(const Vec3f& m, const Vec3f& wo) {
    return std::clamp(dot(wo, m), 0.0f, 1.0f);
  }
  /// Of facets that reflect what `fresnel` tells of the cosine to their normals.
  template <typename Fresnel>
  AlbedoTables albedo_tables(const Fresnel& fresnel) const {
    const FacetRange range = facets_.range();
    return {range.least_log_alpha, range.largest_log_alpha, range.is_isotropic,
            [range, fresnel](float log_alpha, const Vec3f& wo, const Vec2f& u) {
              return sample_lobe(range.at(log_alpha), wo, u, fresnel).weight;
            }};
  }

  /// f; `visible` is the density of facets with normal m that neither way is hidden.
  Spectrum value_of(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi, const Vec3f& m,
                    float visible) const {
    const Spectrum fresnel = fresnel_conductor(cosine_to(m, wo), metal_.at(context));
    return context.value_of(*reflectance_) * fresnel * (visible / (4 * wo.z * wi.z));
  }

  /// By the density of the facet's normal; the cosine is that of the angle to it.
  static float pdf_of_reflection(float pdf_of_facet, float cos_facet) {
    return cos_facet > 0 ? pdf_of_facet / (4 * cos_facet) : 0.0f;
  }

  /// Without the texture. Light that a facet sends below the horizon is lost.
  template <typename Fresnel>
  static BsdfSample sample_lobe(const MicrofacetDistribution& facets, const Vec3f& wo,
                                const Vec2f& u, const Fresnel& fresnel) {
    BsdfSample sample;
    const Vec3f m = facets.sample(wo, u);
    sample.wi = reflect(wo, m);
    sample.pdf_solid_angle = pdf_of_reflection(facets.pdf(wo, m), dot(wo, m));
    if (sample.wi.z <= 0 || !(sample.pdf_solid_angle > 0)) return {};
    // f·cosθ_i/pdf; D cancels.
    const float cos_facet = dot(wo, m);
    const float hidden = facets.masking(wo) * facets.masking(sample.wi) * facets.density(m);
    sample.weight = fresnel(cosine_to(m, wo)) * (hidden * cos_facet / (wo.z * facets.pdf(wo, m)));
    sample.event = Lobes::glossy;
    return sample;
  }

  RoughFacets facets_;
  MetalFresnel metal_;
  std::shared_ptr<const Texture> reflectance_;
  AlbedoTables albedo_;  ///< in RGB mode, without the texture
  AlbedoTables means_;   ///< of 1, schlick_weight and lazanyi_weight over what facets reflect
};

TypeInfo make_roughconductor_info() {
  TypeInfo info{"bsdf", "roughconductor", "Rough metal; black seen from behind, see 'twosided'.",
                rough_facets_parameters()};
  for (Parameter& parameter : conductor_parameters())
    info.parameters.push_back(std::move(parameter));
  return info;
}

const TypeInfo& roughconductor_info() {
  static const TypeInfo info = make_roughconductor_info();
  return info;
}

std::shared_ptr<const Bsdf> create_roughconductor(const BsdfInputs& inputs) {
  return std::make_shared<RoughConductor>(rough_facets_of(inputs), metal_fresnel_of(inputs),
                                          inputs.texture("specular_reflectance"));
}

}  // namespace

BsdfType roughconductor_type() { return {roughconductor_info(), 0, 0, create_roughconductor}; }

}  // namespace kaustik
