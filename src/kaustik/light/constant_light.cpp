#include "kaustik/base/warp.h"
#include "kaustik/light/environment_light.h"

namespace kaustik {
namespace {

/// The same radiance from every direction around the scene.
class ConstantLight final : public EnvironmentLight {
 public:
  ConstantLight(const Spectrum& radiance, const EmissionDisk& disk)
      : EnvironmentLight(disk), radiance_(radiance) {}

  Spectrum background(const Vec3f&) const override { return radiance_; }
  float expected_irradiance(const LightQuery&) const override { return pi * radiance_.sum(); }

 private:
  Spectrum fluence() const override { return radiance_ * (4.0f * pi); }
  Vec3f sample_direction(const Vec2f& u, Purpose) const override { return square_to_sphere(u); }
  float direction_pdf(const Vec3f&, Purpose) const override { return sphere_pdf; }

  Spectrum radiance_;
};

std::unique_ptr<Light> create_constant(const LightInputs& inputs) {
  return with_finite_power(std::make_unique<ConstantLight>(emission_argument(inputs, "radiance"),
                                                           EmissionDisk(inputs.scene_bounds)),
                           inputs);
}

}  // namespace

LightType constant_light_type() {
  static const TypeInfo info{
      "emitter",
      "constant",
      "The same light from every direction around the scene.",
      {color_parameter("radiance", 1, "Radiance.").in("W/(sr·m²)"),
       ignored_parameter("to_world", ParameterKind::transform), ignored_sampling_weight()}};
  return {info, false, create_constant};
}

}  // namespace kaustik
