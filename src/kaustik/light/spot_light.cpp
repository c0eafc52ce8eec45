#include "kaustik/light/light_kinds.h"
#include "kaustik/light/spot_arguments.h"

namespace kaustik {
namespace {

/// Shines from a point into a cone about its +z.
class SpotLight final : public PlacedLight {
 public:
  SpotLight(const SpectralValue& intensity, const Vec3f& position, const Vec3f& axis,
            const SpotCone& cone, const ClassicalAttenuation& attenuation)
      : intensity_(intensity), point_(free_point(position)), frame_(axis), cone_(cone) {
    traits_.is_delta = true;
    traits_.power = intensity.rgb() * cone.solid_angle();
    LightBounds& bounds = traits_.bounds;
    bounds.position.extendBy(position);
    bounds.axis = frame_.z;
    bounds.cos_angle = bounds.cos_spread = cone.cos_cutoff();
    traits_.ball = cone.emission_ball(bounds.position, frame_.z, intensity.rgb().sum());
    traits_.attenuation = attenuation;
  }

  float expected_irradiance(const LightQuery& query) const override {
    const LightSample at = toward_point(point_, query.reference);
    if (!at.delta) return 0;
    return intensity_.rgb().sum() * cone_.falloff(frame_.to_local(-at.direction)) /
           sqr(at.distance) * receiver_cosine(query, at.direction);
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result = toward_point(point_, query.reference);
    if (!result.delta) return result;
    const float falloff = cone_.falloff(frame_.to_local(-result.direction));
    if (falloff > 0) {
      result.radiance = intensity_.at(query.wavelengths) * (falloff / sqr(result.distance));
      result.pdf_solid_angle = 1;
    }
    return result;
  }

  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }

  Spectrum emitted(const SurfacePoint&, const Vec3f& direction,
                   const Wavelengths& wavelengths) const override {
    return intensity_.at(wavelengths) * cone_.falloff(frame_.to_local(direction));
  }
  EmissionSample sample_emission(const Vec2f&, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result = sample_origin({});
    const Vec3f local = cone_.sample(u_direction);
    result.direction = frame_.to_world(local);
    result.pdf_direction = cone_.pdf(local);
    if (result.pdf_direction > 0)
      result.flux = intensity_.at(wavelengths) * (cone_.falloff(local) / result.pdf_direction);
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f& direction) const override {
    return cone_.pdf(frame_.to_local(direction));
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
  Frame frame_;
  SpotCone cone_;
};

std::unique_ptr<Light> create_spot(const LightInputs& inputs) {
  const Transform& to_world = emitter_transform(inputs);
  if (!keeps_angles(to_world))
    throw Error(ErrorKind::input, "'to_world' distorts the cone of this spot",
                "leave out shear and scaling by unequal factors",
                inputs.arguments.place_of("to_world"));
  const Vec3f position = to_world.point({0, 0, 0});
  return with_finite_power(
      std::make_unique<SpotLight>(
          emission_argument(inputs, "intensity"), position, normalize(to_world.vector({0, 0, 1})),
          spot_cone_argument(inputs.arguments), ClassicalAttenuation(inputs.arguments, position)),
      inputs);
}

}  // namespace

LightType spot_light_type() {
  static const TypeInfo info = [] {
    std::vector<Parameter> rows = spot_cone_parameters();
    rows.insert(rows.begin(),
                color_parameter("intensity", 1, "Radiant intensity within the beam.").in("W/sr"));
    rows.push_back(to_world_parameter("World from the light, which shines along its +z."));
    rows.push_back(attenuation_parameter());
    rows.push_back(ignored_sampling_weight());
    return TypeInfo{"emitter", "spot", "Light from a point into a cone about its +z axis.", rows};
  }();
  return {info, false, create_spot};
}

}  // namespace kaustik
