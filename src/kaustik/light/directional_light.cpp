#include "kaustik/light/light_kinds.h"

namespace kaustik {
namespace {

/// Parallel rays from infinity.
class DirectionalLight final : public Light {
 public:
  DirectionalLight(const Spectrum& irradiance, const Vec3f& direction, const EmissionDisk& disk)
      : irradiance_(irradiance), direction_(direction), disk_(disk) {}

  Spectrum power() const override { return irradiance_ * disk_.area(); }
  LightBounds bounds() const override {
    LightBounds b;
    b.axis = direction_;
    b.cos_angle = b.cos_spread = 1;
    b.infinite = true;
    return b;
  }
  bool is_delta() const override { return true; }
  bool is_infinite() const override { return true; }

  float expected_irradiance(const LightQuery& query) const override {
    return irradiance_.sum() * receiver_cosine(query, -direction_);
  }

  LightSample sample_toward(const LightQuery&, const Vec2f&) const override {
    LightSample result;
    result.only_sampled = true;
    result.direction = -direction_;
    result.delta = true;
    result.radiance = irradiance_;
    result.pdf_solid_angle = 1;
    return result;
  }

  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f&) const override {
    EmissionSample result;
    result.point = free_point(disk_.origin(direction_, u_position));
    result.direction = direction_;
    result.pdf_position = 1.0f / disk_.area();
    result.pdf_direction = 1;
    result.flux = power();
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1.0f / disk_.area(); }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f&) const override { return 1; }

  Spectrum emitted_from(const SurfacePoint&, const Vec3f&) const override { return irradiance_; }
  Vec3f sample_travel_direction(const Vec2f&, float& pdf) const override {
    pdf = 1;
    return direction_;
  }

 private:
  Spectrum irradiance_;
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
      {color_parameter("irradiance", 1, "What a surface across the direction receives.").in("W/m²"),
       optional(point_parameter("direction", {0, 0, 1},
                                "In which light travels; instead of `to_world`."))
           .instead_of("to_world")
           .moved(WhenMoved::turned),
       to_world_parameter("World from the light, which shines along its +z."),
       ignored_sampling_weight()}};
  return {info, false, create_directional};
}

}  // namespace kaustik
