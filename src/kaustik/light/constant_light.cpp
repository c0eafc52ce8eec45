#include "kaustik/base/warp.h"
#include "kaustik/light/light_kinds.h"

namespace kaustik {
namespace {

/// The same radiance from every direction around the scene.
class ConstantLight final : public Light {
 public:
  ConstantLight(const Spectrum& radiance, const EmissionDisk& disk)
      : radiance_(radiance), disk_(disk) {}

  Spectrum power() const override { return radiance_ * (4.0f * pi * disk_.area()); }
  LightBounds bounds() const override {
    LightBounds b;
    b.infinite = true;
    return b;
  }
  bool is_delta() const override { return false; }
  bool is_infinite() const override { return true; }

  float expected_irradiance(const LightQuery&) const override { return pi * radiance_.sum(); }

  LightSample sample_toward(const LightQuery&, const Vec2f& u) const override {
    LightSample result;
    result.direction = square_to_sphere(u);
    result.radiance = radiance_;
    result.pdf_solid_angle = sphere_pdf;
    return result;
  }
  float pdf_toward_direction(const Vec3f&) const override { return sphere_pdf; }
  Spectrum background(const Vec3f&) const override { return radiance_; }

  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f& u_direction) const override {
    EmissionSample result;
    result.direction = sample_travel_direction(u_direction, result.pdf_direction);
    result.point = free_point(disk_.origin(result.direction, u_position));
    result.pdf_position = 1.0f / disk_.area();
    result.flux = power();
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1.0f / disk_.area(); }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f&) const override {
    return sphere_pdf;
  }

  Spectrum emitted_from(const SurfacePoint&, const Vec3f&) const override { return radiance_; }
  Vec3f sample_travel_direction(const Vec2f& u, float& pdf) const override {
    pdf = sphere_pdf;
    return square_to_sphere(u);
  }

 private:
  Spectrum radiance_;
  EmissionDisk disk_;
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
