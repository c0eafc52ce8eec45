#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/material/plastic_base.h"

namespace kaustik {
namespace {

/// A matt base under a smooth transparent coat; black from behind.
class Plastic final : public Bsdf {
 public:
  Plastic(PlasticBase base, float ratio, std::shared_ptr<const Texture> reflectance)
      : Bsdf({.lobes = Lobes::diffuse | Lobes::delta,
              .is_lambertian = false,
              .needs = base.needs() | texture_needs({reflectance.get()})}),
        base_(std::move(base)),
        ratio_(ratio),
        even_light_enters_(1 - reflectance_of_even_light(ratio)),
        reflectance_(std::move(reflectance)) {}

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0 || wi.z <= 0) return Spectrum();
    return base_.coupled_reflectance(context) * (inv_pi * entering(wo) * entering(wi));
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0 || wi.z <= 0) return 0;
    return (1 - mirror_chance(context, wo, lobes)) * cosine_hemisphere_pdf(wi.z);
  }

  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    return {eval(context, wo, wi, Lobes::diffuse),
            {},
            pdf(context, wo, wi, Lobes::all),
            pdf(context, wi, wo, Lobes::all)};
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & (Lobes::diffuse | Lobes::delta)) || wo.z <= 0) return {};
    const float chance = mirror_chance(context, wo, lobes);
    if (u_lobe < chance)
      return {.wi = {-wo.x, -wo.y, wo.z},
              .weight = mirrored(context, wo) / chance,
              .pdf_solid_angle = chance,
              .event = Lobes::delta};
    const Vec3f wi = square_to_cosine_hemisphere(u);
    const float density = (1 - chance) * cosine_hemisphere_pdf(wi.z);
    if (!(density > 0)) return {};
    return {
        .wi = wi,
        .weight = base_.coupled_reflectance(context) * (entering(wo) * entering(wi) / (1 - chance)),
        .pdf_solid_angle = density,
        .event = Lobes::diffuse};
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z <= 0) return Spectrum();
    Spectrum sum;
    if (any(lobes & Lobes::delta)) sum += mirrored(context, wo);
    if (any(lobes & Lobes::diffuse)) sum += scattered(context, wo);
    return sum;
  }

 private:
  /// Share of the light from there that the coat lets through.
  float entering(const Vec3f& w) const { return 1 - fresnel_dielectric(w.z, ratio_).reflectance; }
  Spectrum mirrored(const BsdfContext& context, const Vec3f& wo) const {
    return context.value_of(*reflectance_) * fresnel_dielectric(wo.z, ratio_).reflectance;
  }
  Spectrum scattered(const BsdfContext& context, const Vec3f& wo) const {
    return base_.coupled_reflectance(context) * (entering(wo) * even_light_enters_);
  }
  /// With which sample() takes the coat, of the lobes asked for.
  float mirror_chance(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const {
    if (!any(lobes & Lobes::delta)) return 0;
    if (!any(lobes & Lobes::diffuse)) return 1;
    const float mirror = mirrored(context, wo).max_lane(), base = scattered(context, wo).max_lane();
    return mirror + base > 0 ? mirror / (mirror + base) : 0.0f;
  }

  PlasticBase base_;
  float ratio_;
  float even_light_enters_;
  std::shared_ptr<const Texture> reflectance_;
};

const TypeInfo& plastic_info() {
  static const TypeInfo info{"bsdf", "plastic",
                             "Matt base under a smooth transparent coat; black seen from behind.",
                             plastic_parameters()};
  return info;
}

std::shared_ptr<const Bsdf> create_plastic(const BsdfInputs& inputs) {
  const float ratio = plastic_ratio_of(inputs.arguments);
  return std::make_shared<Plastic>(
      PlasticBase(inputs.texture("diffuse_reflectance"), inputs.arguments.boolean("nonlinear"),
                  ratio, reflectance_of_even_light(1 / ratio)),
      ratio, inputs.texture("specular_reflectance"));
}

}  // namespace

BsdfType plastic_type() { return {plastic_info(), 0, 0, create_plastic}; }

}  // namespace kaustik
