#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/conductor_arguments.h"

namespace kaustik {
namespace {

/// Smooth metal; black seen from behind.
class Conductor final : public Bsdf {
 public:
  Conductor(MetalFresnel metal, std::shared_ptr<const Texture> reflectance)
      : Bsdf({.lobes = Lobes::delta, .needs = metal.needs() | texture_needs({reflectance.get()})}),
        metal_(std::move(metal)),
        reflectance_(std::move(reflectance)) {}

  Spectrum eval(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override {
    return Spectrum();
  }
  float pdf(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override { return 0; }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float, const Vec2f&,
                    Lobes lobes) const override {
    BsdfSample sample;
    if (!any(lobes & Lobes::delta) || wo.z <= 0) return sample;
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.pdf_solid_angle = 1;
    sample.weight = albedo(context, wo, lobes);
    sample.event = Lobes::delta;
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::delta) || wo.z <= 0) return Spectrum();
    return context.value_of(*reflectance_) * fresnel_conductor(wo.z, metal_.at(context));
  }

 private:
  MetalFresnel metal_;
  std::shared_ptr<const Texture> reflectance_;
};

const TypeInfo& conductor_info() {
  static const TypeInfo info{"bsdf", "conductor",
                             "Smooth metal; black seen from behind, see 'twosided'.",
                             conductor_parameters()};
  return info;
}

std::shared_ptr<const Bsdf> create_conductor(const BsdfInputs& inputs) {
  return std::make_shared<Conductor>(metal_fresnel_of(inputs),
                                     inputs.texture("specular_reflectance"));
}

}  // namespace

BsdfType conductor_type() { return {conductor_info(), 0, 0, create_conductor}; }

}  // namespace kaustik
