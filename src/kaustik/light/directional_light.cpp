#include "kaustik/light/light_kinds.h"

namespace kaustik {
namespace {

/// Parallel rays from infinity.
class DirectionalLight final : public DistantLight {
 public:
  DirectionalLight(const SpectralValue& irradiance, const Vec3f& direction,
                   const EmissionDisk& disk)
      : irradiance_(irradiance), direction_(direction), disk_(disk) {
    traits_.is_delta = true;
    traits_.power = irradiance.rgb() * disk.area();
    LightBounds& bounds = traits_.bounds;
    bounds.axis = direction;
    bounds.cos_angle = bounds.cos_spread = 1;
    bounds.infinite = true;
  }

  float expected_irradiance(const LightQuery& query) const override {
    return irradiance_.rgb().sum() * receiver_cosine(query, -direction_);
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result;
    result.only_sampled = true;
    result.direction = -direction_;
    result.delta = true;
    result.radiance = irradiance_.at(query.wavelengths);
    result.pdf_solid_angle = 1;
    return result;
  }

  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }
  Spectrum background(const Vec3f&, const Wavelengths&) const override { return {}; }

  Spectrum emitted(const SurfacePoint&, const Vec3f&,
                   const Wavelengths& wavelengths) const override {
    return irradiance_.at(wavelengths);
  }
  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f&,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result;
    result.point = free_point(disk_.origin(direction_, u_position));
    result.direction = direction_;
    result.pdf_position = 1.0f / disk_.area();
    result.pdf_direction = 1;
    result.flux = irradiance_.at(wavelengths) * disk_.area();
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1.0f / disk_.area(); }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f&) const override { return 1; }
  TravelDirection sample_travel_direction(const Vec2f&) const override { return {direction_, 1}; }

 private:
  SpectralValue irradiance_;
  Vec3f direction_;  ///< of travel
  EmissionDisk disk_;
};

Vec3f travel_direction(const LightInputs& inputs) {
  if (!inputs.arguments.given("direction"))
    return normalize(emitter_transform(inputs).vector({0, 0, 1}));
  const Vec3d given = inputs.arguments.point("direction");
  if (!(given.length() > 0))
    throw Error(ErrorKind::input, "'direction' is zero",
                "give the direction in which light travels",
                inputs.arguments.place_of("direction"));
  return Vec3f(given.normalized());
}

std::unique_ptr<Light> create_directional(const LightInputs& inputs) {
  return with_finite_power(std::make_unique<DirectionalLight>(
                               emission_argument(inputs, "irradiance"), travel_direction(inputs),
                               EmissionDisk(inputs.scene_bounds)),
                           inputs);
}

}  // namespace

LightType directional_light_type() {
  static const TypeInfo info{
      "emitter",
      "directional",
      "Parallel light from infinitely far away.",
      {color_parameter("irradiance", 1, "Irradiance on a surface across the direction.").in("W/m²"),
       optional(point_parameter("direction", {0, 0, 1},
                                "Direction in which light travels, instead of `to_world`."))
           .instead_of("to_world")
           .moved(WhenMoved::turned),
       to_world_parameter(
           "Transform from the light's space to the world. The light shines along +z."),
       ignored_sampling_weight()}};
  return {info, false, create_directional};
}

}  // namespace kaustik
