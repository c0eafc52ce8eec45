#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

class BlendPhase final : public PhaseFunction {
 public:
  BlendPhase(std::shared_ptr<const PhaseFunction> first,
             std::shared_ptr<const PhaseFunction> second, float weight)
      : first_(std::move(first)), second_(std::move(second)), weight_(weight) {}

  float eval(const Vec3f& wo, const Vec3f& wi) const override {
    return (1 - weight_) * first_->eval(wo, wi) + weight_ * second_->eval(wo, wi);
  }

  /// What chose one of the two becomes a fresh number.
  Vec3f sample(const Vec3f& wo, const Vec2f& u) const override {
    if (u.x < weight_)
      return second_->sample(wo, {std::min(u.x / weight_, one_minus_epsilon), u.y});
    return first_->sample(wo, {std::min((u.x - weight_) / (1 - weight_), one_minus_epsilon), u.y});
  }

  float mean_cosine() const override {
    return (1 - weight_) * first_->mean_cosine() + weight_ * second_->mean_cosine();
  }

 private:
  std::shared_ptr<const PhaseFunction> first_, second_;
  float weight_;
};

const TypeInfo& blendphase_info() {
  static const TypeInfo info{
      "phase",
      "blendphase",
      "Mixes two nested phase functions, in the order of their names.",
      {number_parameter("weight", 0.5, "Weight of the second phase function.")
           .range(0, 1)
           .clamped()}};
  return info;
}

std::shared_ptr<const PhaseFunction> create_blendphase(const PhaseFunctionInputs& inputs) {
  return blended_phase_function(inputs.nested.at(0), inputs.nested.at(1),
                                float(inputs.arguments.number("weight")));
}

}  // namespace

std::shared_ptr<const PhaseFunction> blended_phase_function(
    std::shared_ptr<const PhaseFunction> first, std::shared_ptr<const PhaseFunction> second,
    float weight) {
  return std::make_shared<BlendPhase>(std::move(first), std::move(second), weight);
}

PhaseFunctionType blendphase_type() { return {blendphase_info(), create_blendphase, 2}; }

}  // namespace kaustik
