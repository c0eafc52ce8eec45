#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/oren_nayar.h"

namespace kaustik {
namespace {

/// Matt surface of facets that are matt themselves; black from behind.
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
    return OrenNayar(roughness_at(context)).eval(context.value_of(*reflectance_), wo, wi);
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
    return OrenNayar(roughness_at(context)).albedo(context.value_of(*reflectance_), wo.z);
  }

 private:
  float roughness_at(const BsdfContext& context) const {
    return std::clamp(context.scalar_of(*roughness_), 0.0f, 1.0f);
  }

  std::shared_ptr<const Texture> reflectance_, roughness_;
};

const TypeInfo& roughdiffuse_info() {
  static const TypeInfo info{
      "bsdf",
      "roughdiffuse",
      "Matt surface with rough facets, such as plaster or the moon; black seen from behind.",
      {color_parameter("reflectance", 0.5, "Fraction of light that a facet reflects.")
           .range(0, 1)
           .textured(),
       number_parameter("roughness", 0.5, "Roughness: 0 is 'diffuse', 1 is the maximum.")
           .range(0, 1)
           .clamped()
           .textured(),
       optional(number_parameter("alpha", 0.2,
                                 "Mitsuba 0.6: root mean square slope of the facets, instead of "
                                 "roughness.")
                    .range(0, 10)
                    .clamped()),
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
