#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// Two bsdfs mixed: f = (1 − w) f_0 + w f_1.
class BlendBsdf final : public Bsdf {
 public:
  BlendBsdf(std::shared_ptr<const Bsdf> first, std::shared_ptr<const Bsdf> second,
            std::shared_ptr<const Texture> weight)
      : first_(std::move(first)), second_(std::move(second)), weight_(std::move(weight)) {}

  Lobes lobes() const override { return first_->lobes() | second_->lobes(); }
  bool transmits() const override { return first_->transmits() || second_->transmits(); }
  SurfaceNeeds needs() const override {
    return first_->needs() | second_->needs() | texture_needs({weight_.get()});
  }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    const float w = weight(context);
    return first_->eval(context, wo, wi, lobes) * (1 - w) +
           second_->eval(context, wo, wi, lobes) * w;
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    const float chance = second_chance(context, lobes);
    return first_->pdf(context, wo, wi, lobes) * (1 - chance) +
           second_->pdf(context, wo, wi, lobes) * chance;
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    const float chance = second_chance(context, lobes), w = weight(context);
    const bool by_second = u_lobe < chance;
    const Bsdf& chosen = by_second ? *second_ : *first_;
    const float rest = by_second ? u_lobe / chance : (u_lobe - chance) / (1 - chance);
    BsdfSample sample = chosen.sample(context, wo, std::min(rest, one_minus_epsilon), u, lobes);
    if (sample.event == Lobes::none) return {};
    const float chosen_chance = by_second ? chance : 1 - chance;
    if (sample.event == Lobes::delta) {
      sample.weight *= (by_second ? w : 1 - w) / chosen_chance;
      sample.pdf_solid_angle *= chosen_chance;
      return sample;
    }
    sample.pdf_solid_angle = pdf(context, wo, sample.wi, lobes);
    return with_event(sample, context, wo, rest, lobes);
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    const float w = weight(context);
    return first_->albedo(context, wo, lobes) * (1 - w) + second_->albedo(context, wo, lobes) * w;
  }

 private:
  /// The event, diffuse or glossy, drawn by the shares of the two in f, with its weight. What the
  /// choice of the lobe has left of `u` are its lower digits.
  BsdfSample with_event(BsdfSample sample, const BsdfContext& context, const Vec3f& wo, float u,
                        Lobes lobes) const {
    const Spectrum diffuse = eval(context, wo, sample.wi, lobes & Lobes::diffuse);
    const Spectrum glossy = eval(context, wo, sample.wi, lobes & Lobes::glossy);
    const float total = diffuse.sum() + glossy.sum();
    if (!(total > 0) || !(sample.pdf_solid_angle > 0)) return {};
    const float diffuse_share = diffuse.sum() / total;
    const float digits = u * 4096 - std::floor(u * 4096);
    const bool is_diffuse = digits < diffuse_share;
    sample.event = is_diffuse ? Lobes::diffuse : Lobes::glossy;
    const float cosine = std::fabs(sample.wi.z) / sample.pdf_solid_angle;
    sample.weight =
        is_diffuse ? diffuse * (cosine / diffuse_share) : glossy * (cosine / (1 - diffuse_share));
    return sample;
  }

  /// What a texture says beyond 1 is 1.
  float weight(const BsdfContext& context) const {
    return std::clamp(context.scalar_of(*weight_), 0.0f, 1.0f);
  }
  /// With which sample() asks the second bsdf: the weight, unless one has none of the lobes.
  float second_chance(const BsdfContext& context, Lobes lobes) const {
    const bool first = any(lobes & first_->lobes()), second = any(lobes & second_->lobes());
    if (first != second) return second ? 1.0f : 0.0f;
    return weight(context);
  }

  std::shared_ptr<const Bsdf> first_, second_;
  std::shared_ptr<const Texture> weight_;
};

const TypeInfo& info() {
  static const TypeInfo info{
      "bsdf",
      "blendbsdf",
      "Mixes two nested bsdfs, by a texture for example.",
      {number_parameter("weight", 0.5, "0: the first one alone, 1: the second one.")
           .range(0, 1)
           .textured()}};
  return info;
}

std::shared_ptr<const Bsdf> create(const BsdfInputs& inputs) {
  for (const auto& nested : inputs.nested)
    if (nested->relief(true) || nested->relief(false))
      throw Error(ErrorKind::input, "bsdf 'blendbsdf' holds one with a bump or normal map",
                  "put the bump map around the 'blendbsdf'", inputs.arguments.place());
  return std::make_shared<BlendBsdf>(inputs.nested[0], inputs.nested[1], inputs.texture("weight"));
}

}  // namespace

BsdfType blendbsdf_type() { return {info(), 2, 2, create}; }

}  // namespace kaustik
