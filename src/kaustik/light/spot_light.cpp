#include "kaustik/light/attenuation.h"
#include "kaustik/light/light_kinds.h"
#include "kaustik/light/spot_arguments.h"

namespace kaustik {
namespace {

/// Shines from a point into a cone about its +z.
class SpotLight final : public Light {
 public:
  SpotLight(const Spectrum& intensity, const Vec3f& position, const Vec3f& axis,
            const SpotCone& cone, const ClassicalAttenuation& attenuation)
      : intensity_(intensity),
        point_(free_point(position)),
        frame_(axis),
        cone_(cone),
        attenuation_(attenuation),
        ball_(cone.emission_ball(SpotLight::bounds().position, frame_.z, intensity.sum())) {}

  Spectrum power() const override { return intensity_ * cone_.solid_angle(); }
  LightBounds bounds() const override {
    LightBounds b;
    b.position.extendBy(point_.position);
    b.axis = frame_.z;
    b.cos_angle = cone_.cos_cutoff();
    b.cos_spread = cone_.cos_cutoff();
    return b;
  }
  bool is_delta() const override { return true; }

  float expected_irradiance(const LightQuery& query) const override {
    const LightSample at = toward_point(point_, query.reference);
    if (!at.delta) return 0;
    return intensity_.sum() * cone_.falloff(frame_.to_local(-at.direction)) / sqr(at.distance) *
           receiver_cosine(query, at.direction);
  }
  const EmissionBall* emission_ball() const override { return &ball_; }
  float classical_attenuation(const Vec3f& reference) const override {
    return attenuation_.factor(length(point_.position - reference));
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result = toward_point(point_, query.reference);
    if (!result.delta) return result;
    const float falloff = cone_.falloff(frame_.to_local(-result.direction));
    if (falloff > 0) {
      result.radiance = intensity_ * (falloff / sqr(result.distance));
      result.pdf_solid_angle = 1;
    }
    return result;
  }

  EmissionSample sample_emission(const Vec2f&, const Vec2f& u_direction) const override {
    EmissionSample result = sample_origin({});
    const Vec3f local = cone_.sample(u_direction);
    result.direction = frame_.to_world(local);
    result.pdf_direction = cone_.pdf(local);
    if (result.pdf_direction > 0)
      result.flux = intensity_ * (cone_.falloff(local) / result.pdf_direction);
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
  Spectrum emitted_from(const SurfacePoint&, const Vec3f& direction) const override {
    return intensity_ * cone_.falloff(frame_.to_local(direction));
  }

 private:
  Spectrum intensity_;
  SurfacePoint point_;  ///< without a normal
  Frame frame_;
  SpotCone cone_;
  ClassicalAttenuation attenuation_;
  EmissionBall ball_;
};

std::unique_ptr<Light> create_spot(const LightInputs& inputs) {
  const Transform& to_world = emitter_transform(inputs);
  if (!keeps_angles(to_world))
    throw Error(ErrorKind::input, "'to_world' distorts the cone of this spot",
                "leave out shear and scaling by unequal factors",
                inputs.arguments.place_of("to_world"));
  return with_finite_power(
      std::make_unique<SpotLight>(emission_argument(inputs, "intensity"), to_world.point({0, 0, 0}),
                                  normalize(to_world.vector({0, 0, 1})),
                                  spot_cone_argument(inputs.arguments),
                                  ClassicalAttenuation(inputs.arguments)),
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
