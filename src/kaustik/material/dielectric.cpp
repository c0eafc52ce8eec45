#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/fresnel.h"

namespace kaustik {
namespace {

/// Smooth boundary between two transparent materials; +z is the exterior.
class Dielectric final : public Bsdf {
 public:
  Dielectric(const SpectralValue& interior, const SpectralValue& exterior,
             std::shared_ptr<const Texture> reflectance,
             std::shared_ptr<const Texture> transmittance)
      : Bsdf({.lobes = Lobes::delta,
              .transmits = true,
              .needs = texture_needs({reflectance.get(), transmittance.get()})}),
        interior_(interior),
        exterior_(exterior),
        interior_over_exterior_(interior.rgb()[0] / exterior.rgb()[0]),
        is_dispersive_(!interior.is_constant() || !exterior.is_constant()),
        reflectance_(std::move(reflectance)),
        transmittance_(std::move(transmittance)) {}

  Spectrum eval(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override {
    return Spectrum();
  }
  float pdf(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override { return 0; }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & Lobes::delta) || wo.z == 0) return {};
    if (lanes_part(context)) return sample_lanes(context, wo, u_lobe, u.x);
    const DielectricFresnel fresnel = fresnel_dielectric(wo.z, interior_over_exterior_);
    if (u_lobe < fresnel.reflectance) {
      BsdfSample sample = reflected(wo, fresnel.reflectance);
      sample.weight = context.value_of(*reflectance_);
      return sample;
    }
    BsdfSample sample = transmitted(context, wo, fresnel, 1 - fresnel.reflectance);
    sample.weight = context.value_of(*transmittance_) * sample.weight;
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::delta) || wo.z == 0) return Spectrum();
    if (lanes_part(context)) {
      const Spectrum reflected = reflected_lanes(context, wo);
      return context.value_of(*reflectance_) * reflected +
             context.value_of(*transmittance_) * (Spectrum(1) - reflected);
    }
    const float reflected = fresnel_dielectric(wo.z, interior_over_exterior_).reflectance;
    return context.value_of(*reflectance_) * reflected +
           context.value_of(*transmittance_) * (1 - reflected);
  }

 private:
  /// Whether each lane has an index of its own. In RGB mode they are all alike.
  bool lanes_part(const BsdfContext& context) const {
    return is_dispersive_ && !context.wavelengths().is_rgb();
  }
  DielectricFresnel fresnel_of_lane(const BsdfContext& context, const Vec3f& wo, int lane) const {
    const Wavelengths& at = context.wavelengths();
    return fresnel_dielectric(wo.z, interior_.at(at)[lane] / exterior_.at(at)[lane]);
  }
  Spectrum reflected_lanes(const BsdfContext& context, const Vec3f& wo) const {
    const Spectrum ratios =
        interior_.at(context.wavelengths()) / exterior_.at(context.wavelengths());
    Spectrum result;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane)
      result.set(lane, fresnel_dielectric(wo.z, ratios[lane]).reflectance);
    return result;
  }

  /// Reflection sends all lanes one way, with a weight for each; of those that are refracted one
  /// goes on, chosen by `u_lane`.
  BsdfSample sample_lanes(const BsdfContext& context, const Vec3f& wo, float u_lobe,
                          float u_lane) const {
    const Wavelengths& wavelengths = context.wavelengths();
    const Spectrum reflectances = reflected_lanes(context, wo);
    const int count = wavelengths.alive_count();
    float chance = 0;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane)
      if (wavelengths.is_alive(lane)) chance += reflectances[lane] / float(count);
    if (u_lobe < chance) {
      BsdfSample sample = reflected(wo, chance);
      sample.weight = context.value_of(*reflectance_) * reflectances / chance;
      return sample;
    }
    int chosen = 0;
    for (int lane = 0, left = std::min(int(u_lane * float(count)), count - 1); left >= 0; ++lane)
      if (wavelengths.is_alive(lane)) chosen = lane, --left;
    const float transmittance = 1 - reflectances[chosen];
    BsdfSample sample =
        transmitted(context, wo, fresnel_of_lane(context, wo, chosen), (1 - chance) / float(count));
    const float weight = context.value_of(*transmittance_)[chosen] * sample.weight[chosen] *
                         transmittance / sample.pdf_solid_angle;
    sample.weight = Spectrum();
    sample.weight.set(chosen, weight);
    sample.only_lane = chosen;
    return sample;
  }

  static BsdfSample reflected(const Vec3f& wo, float chance) {
    return {
        .wi = {-wo.x, -wo.y, wo.z}, .weight = {}, .pdf_solid_angle = chance, .event = Lobes::delta};
  }
  /// Its weight is what becomes of radiance or flux that goes through.
  static BsdfSample transmitted(const BsdfContext& context, const Vec3f& wo,
                                const DielectricFresnel& fresnel, float chance) {
    const float inv_eta = 1 / fresnel.eta;
    return {.wi = {-wo.x * inv_eta, -wo.y * inv_eta, std::copysign(fresnel.cos_transmitted, -wo.z)},
            .weight = Spectrum(context.mode == TransportMode::radiance ? inv_eta * inv_eta : 1.0f),
            .pdf_solid_angle = chance,
            .event = Lobes::delta,
            .transmission = true,
            .eta = fresnel.eta};
  }

  SpectralValue interior_, exterior_;
  float interior_over_exterior_;  ///< in RGB mode, or where it is the same at every wavelength
  bool is_dispersive_;
  std::shared_ptr<const Texture> reflectance_, transmittance_;
};

TypeInfo make_dielectric_info() {
  TypeInfo info{"bsdf", "dielectric", "Smooth transparent surface such as glass or water.",
                dielectric_parameters()};
  info.parameters.push_back(priority_parameter());
  return info;
}

const TypeInfo& dielectric_info() {
  static const TypeInfo info = make_dielectric_info();
  return info;
}

std::shared_ptr<const Bsdf> create_dielectric(const BsdfInputs& inputs) {
  return make_dielectric(dielectric_ior_of(inputs.arguments, "int_ior"),
                         dielectric_ior_of(inputs.arguments, "ext_ior"),
                         inputs.texture("specular_reflectance"),
                         inputs.texture("specular_transmittance"));
}

}  // namespace

std::shared_ptr<const Bsdf> make_dielectric(const SpectralValue& interior,
                                            const SpectralValue& exterior,
                                            std::shared_ptr<const Texture> reflectance,
                                            std::shared_ptr<const Texture> transmittance) {
  return std::make_shared<Dielectric>(interior, exterior, std::move(reflectance),
                                      std::move(transmittance));
}

BsdfType dielectric_type() { return {dielectric_info(), 0, 0, create_dielectric}; }

}  // namespace kaustik
