#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/fresnel.h"

namespace kaustik {
namespace {

/// A pane so thin that light leaves it where it enters, having been reflected between its two sides
/// any number of times: of the share R that one side reflects, R + (1 − R)² R / (1 − R²) =
/// 2R / (1 + R) comes back in all. The rest goes straight on. Both sides are alike.
class ThinDielectric final : public Bsdf {
 public:
  ThinDielectric(const SpectralValue& interior, const SpectralValue& exterior,
                 std::shared_ptr<const Texture> reflectance,
                 std::shared_ptr<const Texture> transmittance)
      : Bsdf({.lobes = Lobes::delta,
              .transmits = true,
              .passes_straight = true,
              .needs = texture_needs({reflectance.get(), transmittance.get()})}),
        interior_(interior),
        exterior_(exterior),
        reflectance_(std::move(reflectance)),
        transmittance_(std::move(transmittance)) {}

  Spectrum eval(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override {
    return Spectrum();
  }
  float pdf(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override { return 0; }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float, const Vec2f&,
                    Lobes lobes) const override {
    if (!any(lobes & Lobes::delta) || wo.z == 0) return {};
    return {.wi = {-wo.x, -wo.y, wo.z},
            .weight = parts_at(context, wo).reflected,
            .pdf_solid_angle = 1,
            .event = Lobes::delta};
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::delta) || wo.z == 0) return Spectrum();
    return parts_at(context, wo).reflected;
  }

  Spectrum straight(const BsdfContext& context, const Vec3f& wo) const override {
    return wo.z == 0 ? Spectrum() : parts_at(context, wo).transmitted;
  }

 private:
  struct Parts {
    Spectrum reflected, transmitted;
  };
  Parts parts_at(const BsdfContext& context, const Vec3f& wo) const {
    const Wavelengths& wavelengths = context.wavelengths();
    const Spectrum ratios = interior_.at(wavelengths) / exterior_.at(wavelengths);
    Spectrum share;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      const float one_side = fresnel_dielectric(std::fabs(wo.z), ratios[lane]).reflectance;
      share.set(lane, 2 * one_side / (1 + one_side));
    }
    return {context.value_of(*reflectance_) * share,
            context.value_of(*transmittance_) * (Spectrum(1) - share)};
  }

  SpectralValue interior_, exterior_;
  std::shared_ptr<const Texture> reflectance_, transmittance_;
};

const TypeInfo& thindielectric_info() {
  static const TypeInfo info{
      "bsdf", "thindielectric",
      "Thin pane of glass. Light goes straight through it, and lamps shine through it directly.",
      dielectric_parameters()};
  return info;
}

std::shared_ptr<const Bsdf> create_thindielectric(const BsdfInputs& inputs) {
  return std::make_shared<ThinDielectric>(dielectric_ior_of(inputs.arguments, "int_ior"),
                                          dielectric_ior_of(inputs.arguments, "ext_ior"),
                                          inputs.texture("specular_reflectance"),
                                          inputs.texture("specular_transmittance"));
}

}  // namespace

BsdfType thindielectric_type() { return {thindielectric_info(), 0, 0, create_thindielectric}; }

}  // namespace kaustik
