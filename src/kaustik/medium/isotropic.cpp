#include "kaustik/base/warp.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

class Isotropic final : public PhaseFunction {
 public:
  float eval(const Vec3f&, const Vec3f&) const override { return sphere_pdf; }
  Vec3f sample(const Vec3f&, const Vec2f& u) const override { return square_to_sphere(u); }
  float mean_cosine() const override { return 0; }
};

const TypeInfo& isotropic_info() {
  static const TypeInfo info{
      "phase", "isotropic", "Scatters evenly into all directions (the default of media).", {}};
  return info;
}

}  // namespace

std::shared_ptr<const PhaseFunction> isotropic_phase_function() {
  static const std::shared_ptr<const PhaseFunction> isotropic = std::make_shared<Isotropic>();
  return isotropic;
}

PhaseFunctionType isotropic_type() {
  return {isotropic_info(), [](const PhaseFunctionInputs&) { return isotropic_phase_function(); }};
}

}  // namespace kaustik
