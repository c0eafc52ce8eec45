#include "kaustik/material/bent_bsdf.h"

namespace kaustik {
namespace {

class BentBsdf final : public Bsdf {
 public:
  BentBsdf(std::shared_ptr<const Bsdf> nested, std::unique_ptr<const Relief> relief)
      : Bsdf(bent(nested->traits())), nested_(std::move(nested)), relief_(std::move(relief)) {}

  const Relief* relief(bool) const override { return relief_.get(); }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    return nested_->eval(context, wo, wi, lobes);
  }
  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    return nested_->pdf(context, wo, wi, lobes);
  }
  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    return nested_->values(context, wo, wi);
  }
  void all_values(const BsdfContext& context, const Vec3f& wo, std::span<Vec3f> wi,
                  std::span<BsdfValues> result) const override {
    nested_->all_values(context, wo, wi, result);
  }
  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    return nested_->sample(context, wo, u_lobe, u, lobes);
  }
  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    return nested_->albedo(context, wo, lobes);
  }
  Spectrum straight(const BsdfContext& context, const Vec3f& wo) const override {
    return nested_->straight(context, wo);
  }

 private:
  static BsdfTraits bent(BsdfTraits traits) {
    traits.needs = traits.needs | SurfaceNeeds::texture | SurfaceNeeds::relief;
    ++traits.size;
    return traits;
  }

  std::shared_ptr<const Bsdf> nested_;
  std::unique_ptr<const Relief> relief_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_bent_bsdf(const BsdfInputs& inputs,
                                           std::unique_ptr<const Relief> relief) {
  const std::shared_ptr<const Bsdf>& nested = inputs.nested.front();
  const bool has_relief = nested->relief(true) || nested->relief(false);
  if (has_relief && !inputs.is_strict) {
    inputs.warn("bsdf '" + inputs.arguments.info().name +
                "' holds another bump or normal map: the inner one holds");
    return nested;
  }
  if (has_relief)
    throw Error(ErrorKind::input,
                "bsdf '" + inputs.arguments.info().name + "' holds another bump or normal map",
                "keep one of the two", inputs.arguments.place());
  return std::make_shared<BentBsdf>(nested, std::move(relief));
}

std::shared_ptr<const Texture> relief_texture(const BsdfInputs& inputs, const std::string& name) {
  auto texture = inputs.texture(name);
  if (!texture)
    throw Error(ErrorKind::input, "bsdf '" + inputs.arguments.info().name + "' has no texture",
                "put a texture into it, named '" + name + "'", inputs.arguments.place());
  return texture;
}

}  // namespace kaustik
