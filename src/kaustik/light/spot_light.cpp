#include "kaustik/light/light_kinds.h"
#include "kaustik/light/slide.h"
#include "kaustik/light/spot_arguments.h"

namespace kaustik {
namespace {

/// Shines from a point into a cone about its +z, through a slide if it has one.
class SpotLight final : public PlacedLight {
 public:
  /// `slide` may be null.
  SpotLight(const SpectralValue& intensity, const Vec3f& position, const Frame& frame,
            const SpotCone& cone, std::unique_ptr<const Slide> slide,
            const ClassicalAttenuation& attenuation)
      : intensity_(intensity),
        point_(free_point(position)),
        frame_(frame),
        cone_(cone),
        slide_(std::move(slide)) {
    traits_.is_delta = true;
    traits_.power =
        slide_ ? intensity.rgb() * slide_->integral() : intensity.rgb() * cone.solid_angle();
    LightBounds& bounds = traits_.bounds;
    bounds.position.extendBy(position);
    bounds.axis = frame_.z;
    bounds.cos_angle = bounds.cos_spread = cone.cos_cutoff();
    if (!slide_)
      traits_.ball = cone.emission_ball(bounds.position, frame_.z, intensity.rgb().sum());
    traits_.attenuation = attenuation;
  }

  float expected_irradiance(const LightQuery& query) const override {
    const LightSample at = toward_point(point_, query.reference);
    if (!at.delta) return 0;
    const Vec3f local = frame_.to_local(-at.direction);
    return brightest(local, {}).sum() * cone_.falloff(local) / sqr(at.distance) *
           receiver_cosine(query, at.direction);
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result = toward_point(point_, query.reference);
    if (!result.delta) return result;
    const Vec3f local = frame_.to_local(-result.direction);
    const float falloff = cone_.falloff(local);
    if (falloff > 0) {
      result.radiance = brightest(local, query.wavelengths) * (falloff / sqr(result.distance));
      result.pdf_solid_angle = 1;
    }
    return result;
  }

  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }

  Spectrum emitted(const SurfacePoint&, const Vec3f& direction,
                   const Wavelengths& wavelengths) const override {
    const Vec3f local = frame_.to_local(direction);
    return brightest(local, wavelengths) * cone_.falloff(local);
  }
  EmissionSample sample_emission(const Vec2f&, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result = sample_origin({});
    if (slide_) {
      result.direction = frame_.to_world(slide_->sample(u_direction));
      // Beside an edge of the table rounding may lead to another cell, for whoever asks later, too.
      result.pdf_direction = slide_->pdf(frame_.to_local(result.direction));
      if (result.pdf_direction > 0)
        result.flux =
            emitted(result.point, result.direction, wavelengths) * (1.0f / result.pdf_direction);
      return result;
    }
    const Vec3f local = cone_.sample(u_direction);
    result.direction = frame_.to_world(local);
    result.pdf_direction = cone_.pdf(local);
    if (result.pdf_direction > 0)
      result.flux = intensity_.at(wavelengths) * (cone_.falloff(local) / result.pdf_direction);
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f& direction) const override {
    const Vec3f local = frame_.to_local(direction);
    return slide_ ? slide_->pdf(local) : cone_.pdf(local);
  }

  EmissionSample sample_origin(const Vec2f&) const override {
    EmissionSample result;
    result.point = point_;
    result.pdf_position = 1;
    return result;
  }

 private:
  /// Before the falloff.
  Spectrum brightest(const Vec3f& local, const Wavelengths& wavelengths) const {
    const Spectrum intensity = intensity_.at(wavelengths);
    return slide_ ? intensity * slide_->value(local, wavelengths) : intensity;
  }

  SpectralValue intensity_;
  SurfacePoint point_;  ///< without a normal
  Frame frame_;
  SpotCone cone_;
  std::unique_ptr<const Slide> slide_;
};

/// The texture as it lies on the cone: its uv square is about the circle of the cutoff.
std::unique_ptr<const Slide> slide_of(const LightInputs& inputs, const SpotCone& cone) {
  if (!inputs.pattern) return nullptr;
  if (!(cone.cutoff() < 0.499f * pi))
    throw Error(ErrorKind::input, "a spot of 90 degrees or more from the axis throws no picture",
                "give a smaller 'cutoff_angle', or leave the texture out",
                inputs.arguments.place_of("cutoff_angle"));
  const float half_size = std::tan(cone.cutoff());
  return std::make_unique<Slide>(inputs.pattern, Vec2f(half_size, half_size),
                                 Slide::Outline::ellipse,
                                 [&](const Vec3f& local) { return cone.falloff(local); });
}

SpectralValue intensity_of(const LightInputs& inputs) {
  const SpectralValue intensity = emission_argument(inputs, "intensity");
  if (!inputs.arguments.given("texture")) return intensity;
  return intensity * SpectralValue::reflectance(inputs.arguments.color("texture"));
}

std::unique_ptr<Light> create_spot(const LightInputs& inputs) {
  const Transform& to_world = emitter_transform(inputs);
  if (!keeps_angles(to_world))
    throw Error(ErrorKind::input, "'to_world' distorts the cone of this spot",
                "leave out shear and scaling by unequal factors",
                inputs.arguments.place_of("to_world"));
  const Vec3f position = to_world.point({0, 0, 0});
  const SpotCone cone = spot_cone_argument(inputs.arguments);
  std::unique_ptr<const Slide> slide = slide_of(inputs, cone);
  const Frame frame = slide ? axes_of(to_world) : Frame(normalize(to_world.vector({0, 0, 1})));
  return with_finite_power(
      std::make_unique<SpotLight>(intensity_of(inputs), position, frame, cone, std::move(slide),
                                  ClassicalAttenuation(inputs.arguments, position)),
      inputs);
}

}  // namespace

LightType spot_light_type() {
  static const TypeInfo info = [] {
    std::vector<Parameter> rows = spot_cone_parameters();
    rows.insert(rows.begin(),
                color_parameter("intensity", 1, "Radiant intensity within the beam.").in("W/sr"));
    rows.push_back(color_parameter("texture", 1,
                                   "Factor on the intensity. A texture is projected along the "
                                   "cone; its square encloses the circle of the cutoff.")
                       .textured());
    rows.push_back(to_world_parameter(
        "Transform from the light's space to the world. The light shines along +z."));
    rows.push_back(attenuation_parameter());
    rows.push_back(ignored_sampling_weight());
    return TypeInfo{"emitter", "spot", "Light from a point into a cone about its +z axis.", rows};
  }();
  return {info, false, create_spot, true};
}

}  // namespace kaustik
