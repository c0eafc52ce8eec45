#include "kaustik/base/warp.h"
#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// Lambertian reflection on the outer side; the back is black.
class Diffuse final : public Bsdf {
 public:
  explicit Diffuse(std::shared_ptr<const Texture> reflectance)
      : Bsdf({.lobes = Lobes::diffuse, .needs = texture_needs({reflectance.get()})}),
        reflectance_(std::move(reflectance)) {}

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0 || wi.z <= 0) return Spectrum();
    return context.value_of(*reflectance_) * inv_pi;
  }

  float pdf(const BsdfContext&, const Vec3f& wo, const Vec3f& wi, Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0 || wi.z <= 0) return 0;
    return cosine_hemisphere_pdf(wi.z);
  }

  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    if (wo.z <= 0 || wi.z <= 0) return {};
    return {context.value_of(*reflectance_) * inv_pi,
            {},
            cosine_hemisphere_pdf(wi.z),
            cosine_hemisphere_pdf(wo.z)};
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float, const Vec2f& u,
                    Lobes lobes) const override {
    BsdfSample sample;
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0) return sample;
    sample.wi = square_to_cosine_hemisphere(u);
    sample.pdf_solid_angle = cosine_hemisphere_pdf(sample.wi.z);
    if (sample.pdf_solid_angle <= 0) return sample;
    sample.weight = context.value_of(*reflectance_);
    sample.event = Lobes::diffuse;
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::diffuse) || wo.z <= 0) return Spectrum();
    return context.value_of(*reflectance_);
  }

 private:
  std::shared_ptr<const Texture> reflectance_;
};

const TypeInfo& diffuse_info() {
  static const TypeInfo info{
      "bsdf",
      "diffuse",
      "Ideally matt surface (Lambert); black seen from behind, see 'twosided'.",
      {color_parameter("reflectance", 0.5, "Fraction of light that is reflected.")
           .range(0, 1)
           .textured()}};
  return info;
}

std::shared_ptr<const Bsdf> create_diffuse(const BsdfInputs& inputs) {
  return std::make_shared<Diffuse>(inputs.texture("reflectance"));
}

}  // namespace

const Bsdf& white_diffuse() {
  static const Diffuse white(make_constant_texture(SpectralValue(1.0f)));
  return white;
}

BsdfType diffuse_type() { return {diffuse_info(), 0, 0, create_diffuse}; }

}  // namespace kaustik
