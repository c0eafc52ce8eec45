// The emitters `distributed` and `distributedspot`: a glowing ball that is no part of the geometry.

#include <fmt/format.h>

#include <optional>

#include "kaustik/base/limits.h"
#include "kaustik/base/warp.h"
#include "kaustik/geometry/make_sphere.h"
#include "kaustik/light/light_kinds.h"
#include "kaustik/light/power_distribution.h"
#include "kaustik/light/spot_arguments.h"

namespace kaustik {
namespace {

struct DistributedSettings {
  SpectralValue intensity;  ///< from afar, on the axis, W/sr
  Vec3f position{0, 0, 0};
  float radius = 0;
  Vec3f axis{0, 0, 1};
  std::optional<SpotCone> cone;
  ClassicalAttenuation attenuation;
  int shadow_samples = 1;
};

/// Shines outward from a sphere that nothing meets: rays pass through it and it throws no shadow.
/// Its radiance is the same for all its points; a spot's depends on the direction to the axis.
class DistributedLight final : public PlacedLight {
 public:
  explicit DistributedLight(const DistributedSettings& settings)
      : radius_(settings.radius),
        position_(settings.position),
        cone_(settings.cone),
        radiance_(settings.intensity * (1.0f / (pi * sqr(settings.radius)))),
        frame_(settings.axis),
        sphere_(make_sphere(Vec3d(settings.position), double(settings.radius))) {
    const Spectrum& intensity = settings.intensity.rgb();
    traits_.power = intensity * (cone_ ? cone_->solid_angle() : 4.0f * pi);
    traits_.shadow_samples = settings.shadow_samples;
    traits_.attenuation = settings.attenuation;
    LightBounds& bounds = traits_.bounds;
    if (cone_) {
      bounds.axis = frame_.z;
      bounds.cos_angle = bounds.cos_spread = cone_->cos_cutoff();
      // Points whose whole hemisphere lies outside of the cone stay dark.
      if (bounds.cos_angle > 0) cap_height_ = 1.0f + safe_sqrt(1.0f - sqr(bounds.cos_angle));
    }
    bounds.position = sphere_->bounds();
    if (radiance_.rgb().is_zero()) return;
    traits_.ball = cone_ ? cone_->emission_ball(bounds.position, frame_.z, intensity.sum())
                         : EmissionBall(bounds, importance_of(traits_.power));
  }

  float expected_irradiance(const LightQuery& query) const override {
    return traits_.ball ? traits_.ball->irradiance(query.reference, query.normal) : 0.0f;
  }

  /// Nothing arrives inside of the sphere.
  LightSample sample_toward(const LightQuery& query, const Vec2f& u) const override {
    LightSample result;
    result.only_sampled = true;
    float pdf = 0;
    const ShapeSample s = sphere_->sample_toward(query.reference, u, pdf);
    const Vec3f to_light = s.point.position - query.reference;
    const float distance = length(to_light);
    if (!(pdf > 0) || !(distance > 0)) return result;
    result.direction = to_light * (1.0f / distance);
    result.distance = distance;
    result.point = free_point(s.point.position);
    if (!(dot(s.point.ng, result.direction) < 0)) return result;
    result.radiance = radiance_.at(query.wavelengths) * falloff(-result.direction);
    result.pdf_solid_angle = pdf;
    return result;
  }

  float pdf_toward(const LightQuery& query, const LightTarget& target) const override {
    SurfacePoint on_sphere = *target.point;
    on_sphere.ng = normal_at(on_sphere);
    if (!(dot(on_sphere.ng, query.reference - on_sphere.position) > 0)) return 0;
    return sphere_->pdf_toward(query.reference, on_sphere);
  }
  Vec3f emitting_normal(const SurfacePoint& point) const override { return normal_at(point); }

  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result = sample_origin(u_position);
    const Frame normal(normal_at(result.point));
    result.direction = cone_ ? frame_.to_world(cone_->sample(u_direction))
                             : normal.to_world(square_to_cosine_hemisphere(u_direction));
    result.pdf_direction = emission_pdf_direction(result.point, result.direction);
    if (result.pdf_direction > 0)
      result.flux = emitted(result.point, result.direction, wavelengths) *
                    (1.0f / (result.pdf_position * result.pdf_direction));
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override {
    return 1.0f / (2.0f * pi * sqr(radius_) * cap_height_);
  }
  float emission_pdf_direction(const SurfacePoint& point, const Vec3f& direction) const override {
    return cone_ ? cone_->pdf(frame_.to_local(direction))
                 : cosine_hemisphere_pdf(dot(normal_at(point), direction));
  }

  EmissionSample sample_origin(const Vec2f& u) const override {
    EmissionSample result;
    const Vec3f normal = frame_.to_world(square_to_cone(u, cap_height_));
    result.point = free_point(position_ + normal * radius_);
    result.pdf_position = emission_pdf_position(result.point);
    return result;
  }
  /// With the cosine to the sphere's normal, which the point has not got: W/(sr·m²).
  Spectrum emitted(const SurfacePoint& point, const Vec3f& direction,
                   const Wavelengths& wavelengths) const override {
    return radiance_.at(wavelengths) *
           (falloff(direction) * std::max(0.0f, dot(normal_at(point), direction)));
  }

 private:
  float falloff(const Vec3f& direction) const {
    return cone_ ? cone_->falloff(frame_.to_local(direction)) : 1.0f;
  }
  Vec3f normal_at(const SurfacePoint& point) const { return normalize(point.position - position_); }

  float radius_;
  Vec3f position_;
  std::optional<SpotCone> cone_;
  SpectralValue radiance_;
  Frame frame_;
  std::shared_ptr<const Shape> sphere_;
  float cap_height_ = 2;  ///< 1 − cosine of the part of the sphere around the axis that shines
};

/// From `intensity`, or from `power` over the solid angle that the light shines into.
SpectralValue intensity_argument(const LightInputs& inputs, float solid_angle) {
  const Arguments& arguments = inputs.arguments;
  if (!arguments.given("power")) return emission_argument(inputs, "intensity");
  if (arguments.given("intensity"))
    throw Error(ErrorKind::input,
                fmt::format("emitter '{}' has both 'intensity' and 'power'", arguments.info().name),
                "give one of them", arguments.place_of("power"));
  return emission_argument(inputs, "power") * (1.0f / solid_angle);
}

std::unique_ptr<Light> create_distributed(const LightInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const bool is_spot = arguments.info().find("cutoff_angle") != nullptr;
  DistributedSettings settings;
  const Transform& to_world = emitter_transform(inputs);
  if (!keeps_angles(to_world))
    throw Error(ErrorKind::input, "'to_world' distorts this light",
                "leave out shear and scaling by unequal factors", arguments.place_of("to_world"));
  settings.position = to_world.point({0, 0, 0});
  if (is_spot) {
    settings.cone = spot_cone_argument(arguments);
    settings.axis = normalize(to_world.vector({0, 0, 1}));
  } else if (arguments.given("position")) {
    settings.position = Vec3f(arguments.point("position"));
  }
  settings.radius = float(arguments.number("radius") * double(length(to_world.vector({0, 0, 1}))));
  settings.intensity =
      intensity_argument(inputs, settings.cone ? settings.cone->solid_angle() : 4.0f * pi);
  settings.attenuation = ClassicalAttenuation(arguments, settings.position);
  settings.shadow_samples = int(arguments.integer("shadow_samples"));
  return with_finite_power(std::make_unique<DistributedLight>(settings), inputs);
}

/// Rows that both have.
std::vector<Parameter> with_shared_rows(std::vector<Parameter> rows) {
  const std::vector<Parameter> shared = {
      number_parameter("radius", 0.1, "Radius of the sphere, which `to_world` scales.")
          .range(1e-6, largest_length)
          .in("m"),
      color_parameter("intensity", 1,
                      "Radiant intensity at a large distance (of a spot: within its beam).")
          .in("W/sr"),
      optional(color_parameter("power", 1, "Total emitted flux, instead of `intensity`.").in("W")),
      to_world_parameter(
          "Transform from the light's space to the world. The centre is at the origin."),
      attenuation_parameter(),
      shadow_samples_parameter(),
      ignored_sampling_weight()};
  rows.insert(rows.end(), shared.begin(), shared.end());
  return rows;
}

}  // namespace

LightType distributed_light_type() {
  static const TypeInfo info{
      "emitter", "distributed",
      "A glowing ball that no ray hits. It is invisible and casts no shadow, but objects in its "
      "light cast soft shadows.",
      with_shared_rows({optional(point_parameter("position", {0, 0, 0},
                                                 "Centre of the ball, instead of `to_world`."))
                            .instead_of("to_world")
                            .moved(WhenMoved::origin)})};
  return {info, false, create_distributed};
}

LightType distributed_spot_light_type() {
  static const TypeInfo info{
      "emitter", "distributedspot",
      "The ball of `distributed`, shining into a cone about its +z axis like `spot`.",
      with_shared_rows(spot_cone_parameters())};
  return {info, false, create_distributed};
}

}  // namespace kaustik
