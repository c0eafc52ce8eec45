#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/material/thin_film.h"

namespace kaustik {
namespace {

/// A pane so thin that light leaves it where it enters, having been reflected between its two sides
/// any number of times: of the share R that one side reflects, R + (1 − R)² R / (1 − R²) =
/// 2R / (1 + R) comes back in all. The rest goes straight on. Both sides are alike. Of a film some
/// hundred nm thick these reflections interfere.
class ThinDielectric final : public Bsdf {
 public:
  ThinDielectric(const SpectralValue& interior, const SpectralValue& exterior,
                 std::shared_ptr<const Texture> reflectance,
                 std::shared_ptr<const Texture> transmittance,
                 std::shared_ptr<const Texture> thickness_factor, float thickness_nm)
      : Bsdf({.lobes = Lobes::delta,
              .transmits = true,
              .passes_straight = true,
              .needs =
                  texture_needs({reflectance.get(), transmittance.get(), thickness_factor.get()})}),
        interior_(interior),
        exterior_(exterior),
        reflectance_(std::move(reflectance)),
        transmittance_(std::move(transmittance)),
        thickness_factor_(std::move(thickness_factor)),
        thickness_nm_(thickness_nm) {}

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
    const Spectrum around = exterior_.at(wavelengths);
    const Spectrum ratios = interior_.at(wavelengths) / around;
    const Spectrum share =
        thickness_nm_ > 0
            ? film_reflectance(std::fabs(wo.z), ratios,
                               thickness_nm_ * context.scalar_of(*thickness_factor_) * around,
                               wavelengths)
            : share_of_pane(std::fabs(wo.z), ratios);
    return {context.value_of(*reflectance_) * share,
            context.value_of(*transmittance_) * (Spectrum(1) - share)};
  }
  /// Without interference.
  static Spectrum share_of_pane(float cosine, const Spectrum& ratios) {
    Spectrum share;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      const float one_side = fresnel_dielectric(cosine, ratios[lane]).reflectance;
      share.set(lane, 2 * one_side / (1 + one_side));
    }
    return share;
  }

  SpectralValue interior_, exterior_;
  std::shared_ptr<const Texture> reflectance_, transmittance_, thickness_factor_;
  float thickness_nm_;  ///< 0: too thick to interfere
};

std::vector<Parameter> pane_parameters() {
  std::vector<Parameter> parameters = dielectric_parameters();
  parameters.push_back(
      optional(number_parameter("thickness", 400,
                                "Of a film, in nm: light from its two sides interferes, as in a "
                                "soap bubble. If absent, the pane is too thick for that."))
          .range(0.001, 1e6));
  parameters.push_back(
      number_parameter("thickness_factor", 1, "Factor on thickness, where the film is not even.")
          .range(0, 1)
          .textured());
  return parameters;
}

const TypeInfo& thindielectric_info() {
  static const TypeInfo info{
      "bsdf", "thindielectric",
      "Thin pane of glass. Light goes straight through it, and lamps shine through it directly.",
      pane_parameters()};
  return info;
}

std::shared_ptr<const Bsdf> create_thindielectric(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  return std::make_shared<ThinDielectric>(
      dielectric_ior_of(arguments, "int_ior"), dielectric_ior_of(arguments, "ext_ior"),
      inputs.texture("specular_reflectance"), inputs.texture("specular_transmittance"),
      inputs.texture("thickness_factor"),
      arguments.has("thickness") ? float(arguments.number("thickness")) : 0.0f);
}

}  // namespace

BsdfType thindielectric_type() { return {thindielectric_info(), 0, 0, create_thindielectric}; }

}  // namespace kaustik
