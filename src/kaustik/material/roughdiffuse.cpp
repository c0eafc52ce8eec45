#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// Matt surface of facets that are matt themselves: Fujii's form of Oren and Nayar's model, and
/// beside it what is scattered between facets, so that white is white at every roughness
/// (Portsmouth, Kutz and Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT 2025).
/// Black from behind.
class RoughDiffuse final : public Bsdf {
 public:
  RoughDiffuse(std::shared_ptr<const Texture> reflectance, std::shared_ptr<const Texture> roughness)
      : Bsdf({.lobes = Lobes::diffuse,
              .is_lambertian = false,
              .needs = texture_needs({reflectance.get(), roughness.get()})}),
        reflectance_(std::move(reflectance)),
        roughness_(std::move(roughness)) {}

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0 || wi.z <= 0) return Spectrum();
    const float roughness = roughness_at(context), scale = scale_of(roughness);
    const float across = wo.x * wi.x + wo.y * wi.y;
    const float once =
        scale * (1 + roughness * (across > 0 ? across / std::max(wo.z, wi.z) : across));
    const Spectrum color = context.value_of(*reflectance_);
    const float mean = mean_albedo(roughness, scale);
    const float between = (1 - albedo_of_once(roughness, scale, wo.z)) *
                          (1 - albedo_of_once(roughness, scale, wi.z)) / std::max(1e-7f, 1 - mean);
    return (color * once + several_times(color, mean) * between) * inv_pi;
  }

  float pdf(const BsdfContext&, const Vec3f& wo, const Vec3f& wi, Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0 || wi.z <= 0) return 0;
    return cosine_hemisphere_pdf(wi.z);
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0) return {};
    const Vec3f wi = square_to_cosine_hemisphere(u);
    const float density = cosine_hemisphere_pdf(wi.z);
    if (!(density > 0)) return {};
    return {.wi = wi,
            .weight = eval(context, wo, wi, Lobes::diffuse) * pi,
            .pdf_solid_angle = density,
            .event = Lobes::diffuse};
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0) return Spectrum();
    const float roughness = roughness_at(context), scale = scale_of(roughness);
    const float once = albedo_of_once(roughness, scale, wo.z);
    const Spectrum color = context.value_of(*reflectance_);
    return color * once + several_times(color, mean_albedo(roughness, scale)) * (1 - once);
  }

 private:
  float roughness_at(const BsdfContext& context) const {
    return std::clamp(context.scalar_of(*roughness_), 0.0f, 1.0f);
  }
  /// Of what is scattered once, of white facets: A of Fujii's form.
  static float scale_of(float roughness) { return 1 / (1 + (0.5f - 2 / (3 * pi)) * roughness); }
  /// Its directional albedo …
  static float albedo_of_once(float roughness, float scale, float cosine) {
    const float sine = safe_sqrt(1 - cosine * cosine);
    const float along = sine * (std::acos(std::min(cosine, 1.0f)) - sine * cosine) +
                        (2.0f / 3) * (sine / cosine * (1 - sine * sine * sine) - sine);
    return std::min(1.0f, scale * (1 + roughness * inv_pi * along));
  }
  /// … and the mean of that over even light.
  static float mean_albedo(float roughness, float scale) {
    return scale * (1 + (2.0f / 3 - 28 / (15 * pi)) * roughness);
  }
  /// Albedo of what is scattered more than once.
  static Spectrum several_times(const Spectrum& color, float mean) {
    return color * color * mean / (Spectrum(1) - color * (1 - mean));
  }

  std::shared_ptr<const Texture> reflectance_, roughness_;
};

const TypeInfo& roughdiffuse_info() {
  static const TypeInfo info{
      "bsdf",
      "roughdiffuse",
      "Matt surface with rough facets, such as plaster or the moon; black seen from behind.",
      {color_parameter("reflectance", 0.5, "Share of the light that a facet reflects.")
           .range(0, 1)
           .textured(),
       number_parameter("roughness", 0.5, "0: as 'diffuse'; 1: as rough as can be.")
           .range(0, 1)
           .textured(),
       optional(number_parameter("alpha", 0.2,
                                 "Mitsuba 0.6: root mean square slope of the facets, instead of "
                                 "roughness.")
                    .range(0, 10)),
       ignored_parameter("use_fast_approx", ParameterKind::boolean)}};
  return info;
}

/// The roughness that scatters as much backward as Oren and Nayar's of this slope: B/A of both.
float roughness_of_slope(double slope) {
  const double sigma_sq = 0.5 * slope * slope;  // as Mitsuba 0.6
  const double a = 1 - 0.5 * sigma_sq / (sigma_sq + 0.33), b = 0.45 * sigma_sq / (sigma_sq + 0.09);
  return float(std::min(1.0, b / a));
}

std::shared_ptr<const Bsdf> create_roughdiffuse(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  auto roughness = inputs.texture("roughness");
  if (arguments.given("alpha")) {
    if (arguments.given("roughness"))
      throw Error(ErrorKind::input, "'alpha' is given together with 'roughness'",
                  "keep one of them", arguments.place_of("alpha"));
    roughness = make_constant_texture(SpectralValue(roughness_of_slope(arguments.number("alpha"))));
  }
  return std::make_shared<RoughDiffuse>(inputs.texture("reflectance"), std::move(roughness));
}

}  // namespace

BsdfType roughdiffuse_type() { return {roughdiffuse_info(), 0, 0, create_roughdiffuse}; }

}  // namespace kaustik
