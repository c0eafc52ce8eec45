#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/fresnel.h"

namespace kaustik {
namespace {

/// Smooth boundary between two transparent materials; +z is the exterior.
class Dielectric final : public Bsdf {
 public:
  Dielectric(float interior_over_exterior, std::shared_ptr<const Texture> reflectance,
             std::shared_ptr<const Texture> transmittance)
      : interior_over_exterior_(interior_over_exterior),
        reflectance_(std::move(reflectance)),
        transmittance_(std::move(transmittance)) {}

  Lobes lobes() const override { return Lobes::delta; }
  bool transmits() const override { return true; }
  SurfaceNeeds needs() const override {
    return texture_needs({reflectance_.get(), transmittance_.get()});
  }

  Spectrum eval(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override {
    return Spectrum();
  }
  float pdf(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override { return 0; }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f&,
                    Lobes lobes) const override {
    BsdfSample sample;
    if (!any(lobes & Lobes::delta) || wo.z == 0) return sample;
    const DielectricFresnel fresnel = fresnel_dielectric(wo.z, interior_over_exterior_);
    sample.event = Lobes::delta;
    if (u_lobe < fresnel.reflectance) {
      sample.wi = {-wo.x, -wo.y, wo.z};
      sample.pdf_solid_angle = fresnel.reflectance;
      sample.weight = context.value_of(*reflectance_);
      return sample;
    }
    const float inv_eta = 1 / fresnel.eta;
    sample.wi = {-wo.x * inv_eta, -wo.y * inv_eta, std::copysign(fresnel.cos_transmitted, -wo.z)};
    sample.pdf_solid_angle = 1 - fresnel.reflectance;
    sample.weight = context.value_of(*transmittance_);
    if (context.mode == TransportMode::radiance) sample.weight *= inv_eta * inv_eta;
    sample.transmission = true;
    sample.eta = fresnel.eta;
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::delta) || wo.z == 0) return Spectrum();
    const float reflected = fresnel_dielectric(wo.z, interior_over_exterior_).reflectance;
    return context.value_of(*reflectance_) * reflected +
           context.value_of(*transmittance_) * (1 - reflected);
  }

 private:
  float interior_over_exterior_;
  std::shared_ptr<const Texture> reflectance_, transmittance_;
};

const TypeInfo& info() {
  static const TypeInfo info{
      "bsdf",
      "dielectric",
      "Smooth transparent surface such as glass or water.",
      {number_or_name_parameter("int_ior", Value(std::string("bk7")), dielectric_names(),
                                "Index of refraction inside, as a number or a material.")
           .range(0.01, 100),
       number_or_name_parameter("ext_ior", Value(std::string("air")), dielectric_names(),
                                "Index of refraction outside, as a number or a material.")
           .range(0.01, 100),
       color_parameter("specular_reflectance", 1, "Factor on what is reflected; 1 is physical.")
           .range(0, 1)
           .textured(),
       color_parameter("specular_transmittance", 1, "Factor on what is transmitted; 1 is physical.")
           .range(0, 1)
           .textured()}};
  return info;
}

float ior(const Arguments& arguments, std::string_view name) {
  const auto value = arguments.number_or_name(name);
  if (const auto* material = std::get_if<std::string>(&value)) return dielectric_ior(*material);
  return float(std::get<double>(value));
}

std::shared_ptr<const Bsdf> create(const BsdfInputs& inputs) {
  return std::make_shared<Dielectric>(
      ior(inputs.arguments, "int_ior") / ior(inputs.arguments, "ext_ior"),
      inputs.texture("specular_reflectance"), inputs.texture("specular_transmittance"));
}

}  // namespace

BsdfType dielectric_type() { return {info(), 0, 0, create}; }

}  // namespace kaustik
