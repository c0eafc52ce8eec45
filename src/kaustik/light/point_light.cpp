#include "kaustik/base/warp.h"
#include "kaustik/light/light_kinds.h"

namespace kaustik {
namespace {

/// Shines alike in all directions from a point.
class PointLight final : public PlacedLight {
 public:
  PointLight(const SpectralValue& intensity, const Vec3f& position,
             const ClassicalAttenuation& attenuation)
      : intensity_(intensity), point_(free_point(position)) {
    traits_.is_delta = true;
    traits_.power = intensity.rgb() * (4.0f * pi);
    traits_.bounds.position.extendBy(position);
    traits_.attenuation = attenuation;
  }

  float expected_irradiance(const LightQuery& query) const override {
    const LightSample at = toward_point(point_, query.reference);
    if (!at.delta) return 0;
    return intensity_.rgb().sum() / sqr(at.distance) * receiver_cosine(query, at.direction);
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result = toward_point(point_, query.reference);
    if (!result.delta) return result;
    result.radiance = intensity_.at(query.wavelengths) / sqr(result.distance);
    result.pdf_solid_angle = 1;
    return result;
  }

  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }

  Spectrum emitted(const SurfacePoint&, const Vec3f&,
                   const Wavelengths& wavelengths) const override {
    return intensity_.at(wavelengths);
  }
  EmissionSample sample_emission(const Vec2f&, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result = sample_origin({});
    result.direction = square_to_sphere(u_direction);
    result.pdf_direction = sphere_pdf;
    result.flux = intensity_.at(wavelengths) * (4.0f * pi);
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

 private:
  SpectralValue intensity_;
  SurfacePoint point_;  ///< without a normal
};

std::unique_ptr<Light> create_point(const LightInputs& inputs) {
  const Vec3f position = inputs.arguments.given("position")
                             ? Vec3f(inputs.arguments.point("position"))
                             : emitter_transform(inputs).point({0, 0, 0});
  return with_finite_power(
      std::make_unique<PointLight>(emission_argument(inputs, "intensity"), position,
                                   ClassicalAttenuation(inputs.arguments, position)),
      inputs);
}

}  // namespace

LightType point_light_type() {
  static const TypeInfo info{
      "emitter",
      "point",
      "Light from a point, equal in all directions.",
      {color_parameter("intensity", 1, "Radiant intensity.").in("W/sr"),
       optional(point_parameter("position", {0, 0, 0}, "Position, instead of `to_world`."))
           .instead_of("to_world")
           .moved(WhenMoved::origin),
       to_world_parameter(
           "Transform from the light's space to the world. The light is at the origin."),
       attenuation_parameter(), ignored_sampling_weight()}};
  return {info, false, create_point};
}

}  // namespace kaustik
