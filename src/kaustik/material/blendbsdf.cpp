#include <fmt/format.h>

#include "kaustik/material/blend.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/lobe_event.h"
#include "kaustik/material/mask.h"

namespace kaustik {
namespace {

/// Two bsdfs mixed: f = (1 − w) f_0 + w f_1.
class BlendBsdf final : public Bsdf {
 public:
  BlendBsdf(std::shared_ptr<const Bsdf> first, std::shared_ptr<const Bsdf> second,
            std::shared_ptr<const Texture> weight)
      : Bsdf(
            {.lobes = first->traits().lobes | second->traits().lobes,
             .transmits = first->traits().transmits || second->traits().transmits,
             .passes_straight = first->traits().passes_straight || second->traits().passes_straight,
             .is_lambertian = first->traits().is_lambertian && second->traits().is_lambertian,
             .needs =
                 first->traits().needs | second->traits().needs | texture_needs({weight.get()}),
             .size = first->traits().size + second->traits().size + 1}),
        first_(std::move(first)),
        second_(std::move(second)),
        weight_(std::move(weight)),
        first_blend_(dynamic_cast<const BlendBsdf*>(first_.get())),
        second_blend_(dynamic_cast<const BlendBsdf*>(second_.get())) {}

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
    return choose(context, wo, u_lobe, u, lobes).sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    const float w = weight(context);
    return first_->albedo(context, wo, lobes) * (1 - w) + second_->albedo(context, wo, lobes) * w;
  }

  Spectrum straight(const BsdfContext& context, const Vec3f& wo) const override {
    const float w = weight(context);
    return first_->straight(context, wo) * (1 - w) + second_->straight(context, wo) * w;
  }

 private:
  /// A sample with what has been found out of its direction; of delta events nothing.
  struct Choice {
    BsdfSample sample;
    Spectrum diffuse, glossy;
    float pdf = 0;
  };

  /// sample(). Blends in this blend tell their values with their samples: asked for them by each
  /// one around them, they would be asked as often as they are deep.
  Choice choose(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                Lobes lobes) const {
    const float chance = second_chance(context, lobes), w = weight(context);
    const bool by_second = u_lobe < chance;
    const Bsdf& chosen = by_second ? *second_ : *first_;
    const BlendBsdf* chosen_blend = by_second ? second_blend_ : first_blend_;
    const float rest = by_second ? u_lobe / chance : (u_lobe - chance) / (1 - chance);
    const float u_nested = std::min(rest, one_minus_epsilon);
    Choice choice;
    if (chosen_blend)
      choice = chosen_blend->choose(context, wo, u_nested, u, lobes);
    else
      choice.sample = chosen.sample(context, wo, u_nested, u, lobes);
    BsdfSample& sample = choice.sample;
    if (sample.event == Lobes::none) return {};
    const float chosen_chance = by_second ? chance : 1 - chance;
    if (sample.event == Lobes::delta) {
      sample.weight *= (by_second ? w : 1 - w) / chosen_chance;
      sample.pdf_solid_angle *= chosen_chance;
      return choice;
    }
    if (!chosen_blend) find_values(chosen, context, wo, lobes, choice);
    Choice other{sample, {}, {}, 0};
    find_values(by_second ? *first_ : *second_, context, wo, lobes, other);
    const Choice& first = by_second ? other : choice;
    const Choice& second = by_second ? choice : other;
    const Spectrum diffuse = first.diffuse * (1 - w) + second.diffuse * w;
    const Spectrum glossy = first.glossy * (1 - w) + second.glossy * w;
    const float pdf = first.pdf * (1 - chance) + second.pdf * chance;
    // What the choice of the lobe has left of `rest` are its lower digits.
    const float digits = rest * 4096 - std::floor(rest * 4096);
    BsdfSample drawn =
        sample_with_event(sample.wi, diffuse, glossy, pdf, sample.transmission, digits);
    if (drawn.event == Lobes::none) return {};
    drawn.eta = sample.eta;
    drawn.only_lane = sample.only_lane;
    return {drawn, diffuse, glossy, pdf};
  }

  static void find_values(const Bsdf& bsdf, const BsdfContext& context, const Vec3f& wo,
                          Lobes lobes, Choice& choice) {
    const Vec3f& wi = choice.sample.wi;
    choice.pdf = bsdf.pdf(context, wo, wi, lobes);
    choice.diffuse = bsdf.eval(context, wo, wi, lobes & Lobes::diffuse);
    choice.glossy = bsdf.eval(context, wo, wi, lobes & Lobes::glossy);
  }

  /// What a texture says beyond 1 is 1.
  float weight(const BsdfContext& context) const {
    return std::clamp(context.scalar_of(*weight_), 0.0f, 1.0f);
  }
  /// With which sample() asks the second bsdf: the weight, unless one has none of the lobes.
  float second_chance(const BsdfContext& context, Lobes lobes) const {
    const bool first = any(lobes & first_->traits().lobes),
               second = any(lobes & second_->traits().lobes);
    if (first != second) return second ? 1.0f : 0.0f;
    return weight(context);
  }

  std::shared_ptr<const Bsdf> first_, second_;
  std::shared_ptr<const Texture> weight_;
  const BlendBsdf *first_blend_, *second_blend_;  ///< the two as blends; null: they are none
};

const TypeInfo& blend_info() {
  static const TypeInfo info{
      "bsdf",
      "blendbsdf",
      "Mixes two nested bsdfs, by a texture for example.",
      {number_parameter("weight", 0.5,
                        "Weight of the second bsdf: 0 is the first alone, 1 the second alone.")
           .range(0, 1)
           .clamped()
           .textured()}};
  return info;
}

std::shared_ptr<const Bsdf> create_blend(const BsdfInputs& inputs) {
  refuse_reliefs_in_blend(inputs);
  return make_blend(with_lobe(inputs.nested[0]), with_lobe(inputs.nested[1]),
                    inputs.texture("weight"));
}

}  // namespace

std::shared_ptr<const Bsdf> make_blend(std::shared_ptr<const Bsdf> first,
                                       std::shared_ptr<const Bsdf> second,
                                       std::shared_ptr<const Texture> weight) {
  return std::make_shared<BlendBsdf>(std::move(first), std::move(second), std::move(weight));
}

void refuse_reliefs_in_blend(const BsdfInputs& inputs) {
  const std::string& type = inputs.arguments.info().name;
  for (const auto& nested : inputs.nested)
    if (nested->relief(true) || nested->relief(false))
      throw Error(ErrorKind::input,
                  fmt::format("bsdf '{}' holds one with a bump or normal map", type),
                  fmt::format("put the bump map around the '{}'", type), inputs.arguments.place());
}

BsdfType blendbsdf_type() { return {blend_info(), 2, 2, create_blend}; }

}  // namespace kaustik
