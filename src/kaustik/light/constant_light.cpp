#include "kaustik/base/warp.h"
#include "kaustik/light/environment_light.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Of the directions from which a surface receives light, this share is drawn evenly over the
/// hemisphere and the rest by the cosine: bump maps bend normals toward the horizon.
constexpr float even_share = 0.1f;

/// The same radiance from every direction around the scene.
class ConstantLight final : public EnvironmentLight {
 public:
  ConstantLight(const SpectralValue& radiance, const EmissionDisk& disk)
      : EnvironmentLight(disk), radiance_(radiance) {
    set_fluence(radiance.rgb() * (4.0f * pi));
  }

  Spectrum background(const Vec3f&, const Wavelengths& wavelengths) const override {
    return radiance_.at(wavelengths);
  }
  float expected_irradiance(const LightQuery&) const override { return pi * radiance_.rgb().sum(); }

 private:
  Vec3f sample_direction(const Vec2f& u, Purpose purpose) const override {
    if (!has_normal(purpose)) return square_to_sphere(u);
    const Frame frame(purpose.receiver->normal);
    if (u.x < even_share) {
      const float z = u.x / even_share, r = safe_sqrt(1 - z * z), phi = 2 * pi * u.y;
      return frame.to_world({r * std::cos(phi), r * std::sin(phi), z});
    }
    return frame.to_world(
        square_to_cosine_hemisphere({rescaled(u.x, even_share, 1 - even_share), u.y}));
  }
  float direction_pdf(const Vec3f& direction, Purpose purpose) const override {
    if (!has_normal(purpose)) return sphere_pdf;
    const float cosine = dot(purpose.receiver->normal, direction);
    if (cosine < 0) return 0;
    return even_share * 2 * sphere_pdf + (1 - even_share) * cosine_hemisphere_pdf(cosine);
  }
  static bool has_normal(Purpose purpose) {
    return purpose.receiver && length_sq(purpose.receiver->normal) > 0;
  }

  SpectralValue radiance_;
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
      {color_parameter("radiance", 1, "Radiance.").in("W/(sr·m²)"), visible_parameter(),
       ignored_parameter("to_world", ParameterKind::transform), ignored_sampling_weight()}};
  return {info, false, create_constant};
}

}  // namespace kaustik
