#include <optional>

#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

Vec3f mirrored(const Vec3f& w) { return {w.x, w.y, -w.z}; }

/// The relief of the back, as high above it as it would be above the front.
class BackRelief final : public Relief {
 public:
  explicit BackRelief(const Relief& front) : front_(front) {}
  Vec3f normal(const ReliefPoint& at) const override {
    return reflect(front_.normal(at), at.normal);
  }

 private:
  const Relief& front_;
};

/// A bsdf on each side; on the back in a frame whose z axis is turned round.
class Twosided final : public Bsdf {
 public:
  Twosided(std::shared_ptr<const Bsdf> front, std::shared_ptr<const Bsdf> back)
      : Bsdf({.lobes = front->traits().lobes | back->traits().lobes,
              .is_lambertian = front->traits().is_lambertian && back->traits().is_lambertian,
              .needs = front->traits().needs | back->traits().needs,
              .size = std::max(front->traits().size, back->traits().size) + 1}),
        front_(std::move(front)),
        back_(std::move(back)) {
    if (const Relief* relief = back_->relief(true)) back_relief_.emplace(*relief);
  }

  const Relief* relief(bool front) const override {
    if (front) return front_->relief(true);
    return back_relief_ ? &*back_relief_ : nullptr;
  }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    return wo.z >= 0 ? front_->eval(context, wo, wi, lobes)
                     : back_->eval(context, mirrored(wo), mirrored(wi), lobes);
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    return wo.z >= 0 ? front_->pdf(context, wo, wi, lobes)
                     : back_->pdf(context, mirrored(wo), mirrored(wi), lobes);
  }

  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    return wo.z >= 0 ? front_->values(context, wo, wi)
                     : back_->values(context, mirrored(wo), mirrored(wi));
  }

  void all_values(const BsdfContext& context, const Vec3f& wo, std::span<Vec3f> wi,
                  std::span<BsdfValues> result) const override {
    if (wo.z >= 0) return front_->all_values(context, wo, wi, result);
    for (Vec3f& w : wi) w = mirrored(w);
    back_->all_values(context, mirrored(wo), wi, result);
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (wo.z >= 0) return front_->sample(context, wo, u_lobe, u, lobes);
    BsdfSample sample = back_->sample(context, mirrored(wo), u_lobe, u, lobes);
    sample.wi.z = -sample.wi.z;
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    return wo.z >= 0 ? front_->albedo(context, wo, lobes)
                     : back_->albedo(context, mirrored(wo), lobes);
  }

 private:
  std::shared_ptr<const Bsdf> front_, back_;
  std::optional<BackRelief> back_relief_;
};

const TypeInfo& twosided_info() {
  static const TypeInfo info{
      "bsdf",
      "twosided",
      "Makes a one-sided bsdf visible from behind. A second nested bsdf is for the back.",
      {boolean_parameter("allow_transmission", false,
                         "Allows a nested bsdf that transmits light. It has two sides already and "
                         "is used as it is; of two, the first.")}};
  return info;
}

std::shared_ptr<const Bsdf> create_twosided(const BsdfInputs& inputs) {
  const auto& nested = inputs.nested;
  const bool transmits = nested.front()->traits().transmits || nested.back()->traits().transmits;
  const bool is_allowed = inputs.arguments.boolean("allow_transmission");
  if (transmits && nested.size() == 1 && is_allowed) {
    inputs.warn("bsdf 'twosided' holds one that transmits light: it is used as it is");
    return nested.front();
  }
  if (transmits && is_allowed && !inputs.is_strict) {
    // What goes in by one of them would have to come out by the other.
    inputs.warn("bsdf 'twosided' holds two, and light is transmitted: the first is used as it is");
    return nested.front();
  }
  if (transmits && is_allowed)
    throw Error(ErrorKind::input, "bsdf 'twosided' holds two, and light is transmitted",
                "keep one of them", inputs.arguments.place());
  if (transmits)
    throw Error(ErrorKind::input, "bsdf 'twosided' holds one that transmits light",
                "use that one without 'twosided'; it has two sides already",
                inputs.arguments.place());
  return std::make_shared<Twosided>(inputs.nested.front(), inputs.nested.back());
}

}  // namespace

BsdfType twosided_type() { return {twosided_info(), 1, 2, create_twosided}; }

}  // namespace kaustik
