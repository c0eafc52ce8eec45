#include "kaustik/material/albedo_table.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/conductor_arguments.h"
#include "kaustik/material/microfacet.h"

namespace kaustik {
namespace {

constexpr double least_alpha = 1e-3, largest_alpha = 10;

/// Facets whose roughness varies over the surface. What a texture says beyond the range of the
/// parameter is taken to its ends: black paint then means as smooth as can be.
class RoughFacets {
 public:
  using Kind = MicrofacetDistribution::Kind;
  using TexturePointer = std::shared_ptr<const Texture>;

  RoughFacets(Kind kind, TexturePointer alpha_u, TexturePointer alpha_v, bool sample_visible)
      : kind_(kind),
        alpha_u_(std::move(alpha_u)),
        alpha_v_(std::move(alpha_v)),
        sample_visible_(sample_visible) {}

  bool is_isotropic() const { return alpha_u_ == alpha_v_; }
  SurfaceNeeds needs() const {
    const SurfaceNeeds textures = texture_needs({alpha_u_.get(), alpha_v_.get()});
    return is_isotropic() ? textures : textures | SurfaceNeeds::tangent;
  }
  MicrofacetDistribution at(const BsdfContext& context) const {
    return {kind_, in_range(context.scalar_of(*alpha_u_)), in_range(context.scalar_of(*alpha_v_)),
            sample_visible_};
  }
  /// Of the roughness along u, which the albedo is tabulated by.
  float log_alpha(const BsdfContext& context) const {
    return std::log2(in_range(context.scalar_of(*alpha_u_)));
  }
  float least_log_alpha() const {
    return alpha_u_->is_constant() ? log_alpha({}) : std::log2(float(least_alpha));
  }
  float largest_log_alpha() const {
    return alpha_u_->is_constant() ? log_alpha({}) : std::log2(in_range(alpha_u_->maximum()));
  }
  /// With a given roughness along u and, where it differs, the mean one along v.
  MicrofacetDistribution of_log_alpha(float log_alpha) const {
    const float alpha = std::exp2(log_alpha);
    const float across = is_isotropic() ? alpha : in_range(luminance_of(alpha_v_->mean()));
    return {kind_, alpha, across, sample_visible_};
  }

 private:
  static float in_range(float alpha) {
    return std::clamp(alpha, float(least_alpha), float(largest_alpha));
  }

  Kind kind_;
  TexturePointer alpha_u_, alpha_v_;
  bool sample_visible_;
};

/// Rough metal after Torrance and Sparrow with Walter et al.'s distributions; black from behind.
class RoughConductor final : public Bsdf {
 public:
  RoughConductor(RoughFacets facets, const SpectralIor& ior,
                 std::shared_ptr<const Texture> reflectance)
      : Bsdf(
            {.lobes = Lobes::glossy, .needs = facets.needs() | texture_needs({reflectance.get()})}),
        facets_(std::move(facets)),
        ior_(ior),
        reflectance_(std::move(reflectance)),
        albedo_(albedo_tables(
            [this](float cos_facet) { return fresnel_conductor(cos_facet, ior_.at({})); })),
        ideal_albedo_(albedo_tables([](float) { return Spectrum(1); })) {}

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
      return fresnel_conductor(cos_facet, ior_.at(context.wavelengths()));
    });
    sample.weight *= context.value_of(*reflectance_);
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z <= 0) return Spectrum();
    const float log_alpha = facets_.log_alpha(context);
    const Wavelengths& wavelengths = context.wavelengths();
    if (wavelengths.is_rgb()) return context.value_of(*reflectance_) * albedo_(log_alpha, wo);
    // There are no tables of every wavelength.
    return context.value_of(*reflectance_) * ideal_albedo_(log_alpha, wo) *
           fresnel_conductor(wo.z, ior_.at(wavelengths));
  }

 private:
  static float cosine_to(const Vec3f& m, const Vec3f& wo) {
    return std::clamp(dot(wo, m), 0.0f, 1.0f);
  }
  /// Of facets that reflect what `fresnel` tells of the cosine to their normals.
  template <typename Fresnel>
  AlbedoTables albedo_tables(const Fresnel& fresnel) const {
    return {facets_.least_log_alpha(), facets_.largest_log_alpha(), facets_.is_isotropic(),
            [this, fresnel](float log_alpha, const Vec3f& wo, const Vec2f& u) {
              return sample_lobe(facets_.of_log_alpha(log_alpha), wo, u, fresnel).weight;
            }};
  }

  /// f; `visible` is the density of facets with normal m that neither way is hidden.
  Spectrum value_of(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi, const Vec3f& m,
                    float visible) const {
    const Spectrum fresnel = fresnel_conductor(cosine_to(m, wo), ior_.at(context.wavelengths()));
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
  SpectralIor ior_;
  std::shared_ptr<const Texture> reflectance_;
  AlbedoTables albedo_;        ///< in RGB mode, without the texture
  AlbedoTables ideal_albedo_;  ///< of facets that reflect everything
};

/// The row of a roughness; `name` is alpha, alpha_u or alpha_v.
Parameter alpha_parameter(const std::string& name, const std::string& sentence) {
  return number_parameter(name, 0.1, sentence).range(least_alpha, largest_alpha).textured();
}

TypeInfo make_info() {
  TypeInfo info{
      "bsdf",
      "roughconductor",
      "Rough metal; black seen from behind, see 'twosided'.",
      {choice_parameter("distribution", "beckmann", {"beckmann", "ggx"},
                        "Distribution of the normals of the microscopic facets."),
       alpha_parameter("alpha", "Roughness; about the root mean square slope of the facets."),
       optional(alpha_parameter("alpha_u", "Roughness along the tangent, instead of alpha.")),
       optional(alpha_parameter("alpha_v", "Roughness across the tangent, instead of alpha.")),
       boolean_parameter("sample_visible", true,
                         "Sample only facets that can be seen: less noise, same result.")}};
  for (Parameter& parameter : conductor_parameters())
    info.parameters.push_back(std::move(parameter));
  return info;
}

const TypeInfo& roughconductor_info() {
  static const TypeInfo info = make_info();
  return info;
}

RoughFacets facets_of(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const auto kind = arguments.text("distribution") == "ggx" ? RoughFacets::Kind::ggx
                                                            : RoughFacets::Kind::beckmann;
  const bool visible = arguments.boolean("sample_visible");
  auto u = inputs.texture("alpha_u"), v = inputs.texture("alpha_v");
  if (!u && !v) {
    auto alpha = inputs.texture("alpha");
    return {kind, alpha, alpha, visible};
  }
  if (arguments.given("alpha"))
    throw Error(ErrorKind::input, "'alpha' is given together with 'alpha_u' or 'alpha_v'",
                "keep alpha or both of the others", arguments.place_of("alpha"));
  if (!u || !v)
    throw Error(ErrorKind::input,
                u ? "'alpha_u' is given without 'alpha_v'" : "'alpha_v' is given without 'alpha_u'",
                "give both, or alpha alone", arguments.place_of(u ? "alpha_u" : "alpha_v"));
  // Isotropic facets are told by one texture for both.
  if (u->is_constant() && v->is_constant() && u->mean() == v->mean()) v = u;
  return {kind, std::move(u), std::move(v), visible};
}

std::shared_ptr<const Bsdf> create_roughconductor(const BsdfInputs& inputs) {
  return std::make_shared<RoughConductor>(facets_of(inputs), conductor_ior(inputs.arguments),
                                          inputs.texture("specular_reflectance"));
}

}  // namespace

BsdfType roughconductor_type() { return {roughconductor_info(), 0, 0, create_roughconductor}; }

}  // namespace kaustik
