#include "kaustik/material/mask.h"

#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

class Mask final : public Bsdf {
 public:
  Mask(std::shared_ptr<const Bsdf> nested, std::shared_ptr<const Texture> opacity,
       std::optional<float> cutoff)
      : Bsdf({.lobes = nested->traits().lobes,
              .transmits = nested->traits().transmits || !opacity->is_constant() ||
                           opacity->mean().max_lane() < cutoff.value_or(1),
              .passes_straight = true,
              .is_lambertian = nested->traits().is_lambertian,
              .needs = nested->traits().needs | texture_needs({opacity.get()}),
              .size = nested->traits().size + 1}),
        nested_(std::move(nested)),
        opacity_(std::move(opacity)),
        cutoff_(cutoff) {}

  const Relief* relief(bool front) const override { return nested_->relief(front); }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    return nested_->eval(context, wo, wi, lobes) * opacity(context);
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    return nested_->pdf(context, wo, wi, lobes);
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    BsdfSample sample = nested_->sample(context, wo, u_lobe, u, lobes);
    sample.weight *= opacity(context);
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    return nested_->albedo(context, wo, lobes) * opacity(context);
  }

  Spectrum straight(const BsdfContext& context, const Vec3f& wo) const override {
    const float share = opacity(context);
    const Spectrum nested =
        nested_->traits().is_null ? clear(context) : nested_->straight(context, wo);
    return clear(context) * (1 - share) + nested * share;
  }

 private:
  /// What passes a hole: all light; nothing in the lane that carries none.
  static Spectrum clear(const BsdfContext& context) {
    return lanes_from_reflectance(spectrum_from_rgb(1, 1, 1), context.wavelengths());
  }
  /// What a texture says beyond 1 is 1.
  float opacity(const BsdfContext& context) const {
    const float given = context.scalar_of(*opacity_);
    if (cutoff_) return given >= *cutoff_ ? 1.0f : 0.0f;
    return std::clamp(given, 0.0f, 1.0f);
  }

  std::shared_ptr<const Bsdf> nested_;
  std::shared_ptr<const Texture> opacity_;
  std::optional<float> cutoff_;
};

const TypeInfo& mask_info() {
  static const TypeInfo info{
      "bsdf",
      "mask",
      "Cuts holes into the nested bsdf. Light goes through them as if there were no surface.",
      {number_parameter("opacity", 0.5, "Fraction of the surface that exists.")
           .range(0, 1)
           .clamped()
           .textured(),
       optional(number_parameter("cutoff", 0.5,
                                 "What has at least this opacity is there, all else is not: holes "
                                 "with sharp edges."))
           .range(0, 1)}};
  return info;
}

std::shared_ptr<const Bsdf> create_mask(const BsdfInputs& inputs) {
  std::optional<float> cutoff;
  if (inputs.arguments.given("cutoff")) cutoff = float(inputs.arguments.number("cutoff"));
  return make_mask(with_lobe(inputs.nested.front()), inputs.texture("opacity"), cutoff);
}

}  // namespace

std::shared_ptr<const Bsdf> make_mask(std::shared_ptr<const Bsdf> nested,
                                      std::shared_ptr<const Texture> opacity,
                                      std::optional<float> cutoff) {
  return std::make_shared<Mask>(std::move(nested), std::move(opacity), cutoff);
}

std::shared_ptr<const Bsdf> with_lobe(std::shared_ptr<const Bsdf> bsdf) {
  if (!bsdf->traits().is_null) return bsdf;
  return make_mask(std::move(bsdf), make_constant_texture(SpectralValue(0)));
}

BsdfType mask_type() { return {mask_info(), 1, 1, create_mask}; }

}  // namespace kaustik
