#include "kaustik/base/warp.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

class Rayleigh final : public PhaseFunction {
 public:
  float eval(const Vec3f& wo, const Vec3f& wi) const override {
    return 0.75f * sphere_pdf * (1 + sqr(dot(wo, wi)));
  }

  /// The distribution of the cosine μ is (4 + 3 μ + μ³)/8: its inverse by Cardano's formula.
  Vec3f sample(const Vec3f& wo, const Vec2f& u) const override {
    const float half = 4 * u.x - 2;
    const float root = std::cbrt(std::fabs(half) + std::sqrt(half * half + 1));
    const float cosine = std::copysign(std::clamp(root - 1 / root, 0.0f, 1.0f), half);
    const float sine = safe_sqrt(1 - cosine * cosine);
    const float phi = 2 * pi * u.y;
    return Frame(-wo).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
  }

  float mean_cosine() const override { return 0; }
};

const TypeInfo& rayleigh_info() {
  static const TypeInfo info{
      "phase",
      "rayleigh",
      "Rayleigh's phase function, for clear air: equal forward and backward, less to the sides.",
      {}};
  return info;
}

}  // namespace

std::shared_ptr<const PhaseFunction> rayleigh_phase_function() {
  static const std::shared_ptr<const PhaseFunction> rayleigh = std::make_shared<Rayleigh>();
  return rayleigh;
}

PhaseFunctionType rayleigh_type() {
  return {rayleigh_info(), [](const PhaseFunctionInputs&) { return rayleigh_phase_function(); }};
}

}  // namespace kaustik
