#include "kaustik/base/field_of_view.h"
#include "kaustik/light/light_kinds.h"
#include "kaustik/light/slide.h"

namespace kaustik {
namespace {

/// Throws a picture from a point: a camera the other way round, with its mapping of directions to
/// the picture. A surface across the axis gets π times the picture over the squared distance, so
/// that a white one at the distance 1 is seen with the picture's values (as in Mitsuba): along θ
/// from the axis the intensity is π times the picture over cos³θ.
class Projector final : public PlacedLight {
 public:
  /// The picture's values are those of the slide times `irradiance`.
  Projector(const SpectralValue& irradiance, const Vec3f& position, const Frame& frame,
            std::unique_ptr<const Slide> slide, const ClassicalAttenuation& attenuation)
      : intensity_(irradiance * pi),
        point_(free_point(position)),
        frame_(frame),
        slide_(std::move(slide)) {
    traits_.is_delta = true;
    traits_.power = intensity_.rgb() * slide_->integral();
    LightBounds& bounds = traits_.bounds;
    bounds.position.extendBy(position);
    bounds.axis = frame_.z;
    bounds.cos_angle = bounds.cos_spread = slide_->cos_angle();
    traits_.attenuation = attenuation;
  }

  /// On the slide's plane a unit of area is seen under cos³.
  static float factor(const Vec3f& local) { return 1.0f / (local.z * local.z * local.z); }

  float expected_irradiance(const LightQuery& query) const override {
    const LightSample at = toward_point(point_, query.reference);
    if (!at.delta) return 0;
    return intensity_toward(frame_.to_local(-at.direction), {}).sum() / sqr(at.distance) *
           receiver_cosine(query, at.direction);
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result = toward_point(point_, query.reference);
    if (!result.delta) return result;
    result.radiance = intensity_toward(frame_.to_local(-result.direction), query.wavelengths) *
                      (1.0f / sqr(result.distance));
    if (!result.radiance.is_zero()) result.pdf_solid_angle = 1;
    return result;
  }

  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }

  Spectrum emitted(const SurfacePoint&, const Vec3f& direction,
                   const Wavelengths& wavelengths) const override {
    return intensity_toward(frame_.to_local(direction), wavelengths);
  }
  EmissionSample sample_emission(const Vec2f&, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result = sample_origin({});
    result.direction = frame_.to_world(slide_->sample(u_direction));
    // Beside an edge of the table rounding may lead to another cell, for whoever asks later, too.
    const Vec3f local = frame_.to_local(result.direction);
    result.pdf_direction = slide_->pdf(local);
    if (result.pdf_direction > 0)
      result.flux = intensity_toward(local, wavelengths) * (1.0f / result.pdf_direction);
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f& direction) const override {
    return slide_->pdf(frame_.to_local(direction));
  }

  EmissionSample sample_origin(const Vec2f&) const override {
    EmissionSample result;
    result.point = point_;
    result.pdf_position = 1;
    return result;
  }

 private:
  Spectrum intensity_toward(const Vec3f& local, const Wavelengths& wavelengths) const {
    const Spectrum value = slide_->value(local, wavelengths);
    if (value.is_zero()) return {};
    return intensity_.at(wavelengths) * value * factor(local);
  }

  SpectralValue intensity_;  ///< along the axis, where the picture is 1
  SurfacePoint point_;       ///< without a normal
  Frame frame_;
  std::unique_ptr<const Slide> slide_;
};

std::unique_ptr<Light> create_projector(const LightInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const Transform& to_world = emitter_transform(inputs);
  if (!keeps_angles(to_world))
    throw Error(ErrorKind::input, "'to_world' distorts the picture of this projector",
                "leave out shear and scaling by unequal factors", arguments.place_of("to_world"));
  const Vec3f position = to_world.point({0, 0, 0});
  const Vec2f half = tan_half_fov(arguments, inputs.pattern ? double(inputs.pattern->aspect()) : 1);
  const auto scale = float(arguments.number("scale"));
  const SpectralValue irradiance =
      inputs.pattern ? SpectralValue(scale) : emission_argument(inputs, "irradiance") * scale;
  // As in the picture of a camera +x is to the left and +y up; uv begin in the upper left corner.
  auto slide = std::make_unique<Slide>(inputs.pattern, Vec2f(-half.x, -half.y),
                                       Slide::Outline::rectangle, Projector::factor);
  return with_finite_power(
      std::make_unique<Projector>(irradiance, position, axes_of(to_world), std::move(slide),
                                  ClassicalAttenuation(arguments, position)),
      inputs);
}

}  // namespace

LightType projector_light_type() {
  static const TypeInfo info = [] {
    std::vector<Parameter> rows = {
        color_parameter("irradiance", 1,
                        "Irradiance on a surface across the axis at distance 1, divided by π. With "
                        "a texture it is a picture, upright as a camera would take it.")
            .in("W/m²")
            .textured(),
        number_parameter("scale", 1, "Factor on the irradiance.").range(0, 1e30)};
    for (Parameter& row : field_of_view_parameters()) rows.push_back(std::move(row));
    rows.push_back(to_world_parameter(
        "Transform from the light's space to the world. The light shines along +z."));
    rows.push_back(attenuation_parameter());
    rows.push_back(ignored_sampling_weight());
    return TypeInfo{"emitter", "projector", "A picture projected from a point.", rows};
  }();
  return {info, false, create_projector};
}

}  // namespace kaustik
