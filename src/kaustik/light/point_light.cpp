#include "kaustik/base/warp.h"
#include "kaustik/light/attenuation.h"
#include "kaustik/light/emission_ball.h"
#include "kaustik/light/light_kinds.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Shines alike in all directions from a point.
class PointLight final : public Light {
 public:
  PointLight(const Spectrum& intensity, const Vec3f& position,
             const ClassicalAttenuation& attenuation)
      : intensity_(intensity),
        point_(free_point(position)),
        attenuation_(attenuation),
        ball_(PointLight::bounds(), importance_of(PointLight::power())) {}

  Spectrum power() const override { return intensity_ * (4.0f * pi); }
  LightBounds bounds() const override {
    LightBounds b;
    b.position.extendBy(point_.position);
    return b;
  }
  bool is_delta() const override { return true; }

  float expected_irradiance(const LightQuery& query) const override {
    const LightSample at = toward_point(point_, query.reference);
    if (!at.delta) return 0;
    return intensity_.sum() / sqr(at.distance) * receiver_cosine(query, at.direction);
  }
  float classical_attenuation(const Vec3f& reference) const override {
    return attenuation_.factor(length(point_.position - reference));
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result = toward_point(point_, query.reference);
    if (!result.delta) return result;
    result.radiance = intensity_ / sqr(result.distance);
    result.pdf_solid_angle = 1;
    return result;
  }

  EmissionSample sample_emission(const Vec2f&, const Vec2f& u_direction) const override {
    EmissionSample result = sample_origin({});
    result.direction = square_to_sphere(u_direction);
    result.pdf_direction = sphere_pdf;
    result.flux = power();
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f&) const override {
    return sphere_pdf;
  }

  EmissionSample sample_origin(const Vec2f&) const override {
    EmissionSample result;
    result.point = point_;
    result.pdf_position = 1;
    return result;
  }
  Spectrum emitted_from(const SurfacePoint&, const Vec3f&) const override { return intensity_; }

 private:
  Spectrum intensity_;
  SurfacePoint point_;  ///< without a normal
  ClassicalAttenuation attenuation_;
  EmissionBall ball_;
};

std::unique_ptr<Light> create_point(const LightInputs& inputs) {
  const Vec3f position = inputs.arguments.given("position")
                             ? Vec3f(inputs.arguments.point("position"))
                             : emitter_transform(inputs).point({0, 0, 0});
  return with_finite_power(
      std::make_unique<PointLight>(emission_argument(inputs, "intensity"), position,
                                   ClassicalAttenuation(inputs.arguments)),
      inputs);
}

}  // namespace

LightType point_light_type() {
  static const TypeInfo info{
      "emitter",
      "point",
      "Light from a point, alike in all directions.",
      {color_parameter("intensity", 1, "Radiant intensity.").in("W/sr"),
       optional(point_parameter("position", {0, 0, 0}, "Where it is; instead of `to_world`."))
           .instead_of("to_world")
           .moved(WhenMoved::origin),
       to_world_parameter("World from the light, which is at the origin."), attenuation_parameter(),
       ignored_sampling_weight()}};
  return {info, false, create_point};
}

}  // namespace kaustik
