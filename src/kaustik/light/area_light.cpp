#include "kaustik/base/warp.h"
#include "kaustik/light/light_kinds.h"
#include "kaustik/light/mesh_faces.h"
#include "kaustik/light/normal_cone.h"
#include "kaustik/light/pattern_points.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Emits from every point of a shape in every direction on the side of its geometric normal, or on
/// both: the same radiance everywhere, or that of a pattern. Points are chosen by geometry; half of
/// those that light a point, and all that emit, by a pattern if there is one.
class AreaLight final : public PlacedLight {
 public:
  /// `pattern` may be null, else `radiance` is its mean; both are multiplied by `scale`.
  AreaLight(const SpectralValue& radiance, std::shared_ptr<const EmissionPattern> pattern,
            float scale, std::shared_ptr<const Shape> light_shape, int shape_index, bool two_sided,
            int shadow_samples)
      : radiance_(radiance * scale),
        pattern_(std::move(pattern)),
        scale_(scale),
        shape_(std::move(light_shape)),
        area_(shape_->area()) {
    traits_.is_two_sided = two_sided;
    traits_.shape = shape_index;
    traits_.shadow_samples = shadow_samples;
    traits_.power = radiance_.rgb() * (pi * emitting_area());
    const DirectionCone normals = two_sided ? DirectionCone() : cone_of_normals(*shape_);
    LightBounds& bounds = traits_.bounds;
    bounds.position = shape_->bounds();
    bounds.axis = normals.axis;
    bounds.cos_spread = normals.cos_angle;
    // The hemispheres about the normals: the cone's angle and another 90°.
    bounds.cos_angle = normals.cos_angle > 0 ? -safe_sqrt(1.0f - sqr(normals.cos_angle)) : -1.0f;
    // Spread over all directions a sheet's light would seem half of what it is in front of it.
    if (!radiance_.rgb().is_zero())
      traits_.ball = EmissionBall(bounds, importance_of(traits_.power) * (two_sided ? 2 : 1));
    const TriangleMesh* mesh = shape_->mesh();
    if (mesh && mesh->triangles.size() >= MeshFaces::least_triangles)
      faces_ = std::make_unique<MeshFaces>(*shape_, two_sided, pattern_.get());
    if (pattern_) points_ = PatternPoints::make(*shape_, *pattern_);
  }

  float expected_irradiance(const LightQuery& query) const override {
    return traits_.ball ? traits_.ball->irradiance(query.reference, query.normal) : 0.0f;
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f& u) const override {
    const Vec3f& reference = query.reference;
    float pdf_solid_angle = 0;
    const ShapeSample s = points_ ? sample_by_pattern(query, u, pdf_solid_angle)
                                  : sample_by_geometry(query, u, pdf_solid_angle);
    LightSample result;
    if (!(pdf_solid_angle > 0)) return result;
    const Vec3f to_light = s.point.position - reference;
    const float distance = length(to_light);
    if (!(distance > 0)) return result;
    result.direction = to_light * (1.0f / distance);
    result.distance = distance;
    result.point = placed(s.point);
    result.on_surface = true;
    if (traits_.is_two_sided || dot(s.point.ng, result.direction) < 0) {
      result.radiance = radiance_at(result.point, query.wavelengths);
      result.pdf_solid_angle = pdf_solid_angle;
    }
    return result;
  }

  float pdf_toward(const LightQuery& query, const LightTarget& target) const override {
    const SurfacePoint& point = *target.point;
    if (!traits_.is_two_sided && !(dot(point.ng, point.position - query.reference) < 0)) return 0;
    const float by_geometry = pdf_by_geometry(query, point);
    if (!points_) return by_geometry;
    return 0.5f *
           (by_geometry + solid_angle_density(query.reference, point, points_->pdf_area(point)));
  }

  Spectrum emitted(const SurfacePoint& point, const Vec3f& direction,
                   const Wavelengths& wavelengths) const override {
    return traits_.is_two_sided || dot(point.ng, direction) > 0 ? radiance_at(point, wavelengths)
                                                                : Spectrum();
  }

  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result = sample_origin(u_position);
    if (!(result.pdf_position > 0)) return result;
    const Vec3f local = square_to_cosine_hemisphere(u_direction);
    result.direction = Frame(result.point.ng).to_world(local);
    result.pdf_direction = cosine_hemisphere_pdf(local.z);
    // Radiance × cosine over (cosine/π) × density of the position.
    if (result.pdf_direction > 0)
      result.flux = radiance_at(result.point, wavelengths) * (pi / result.pdf_position);
    return result;
  }

  float emission_pdf_position(const SurfacePoint& point) const override {
    if (points_) return (traits_.is_two_sided ? 0.5f : 1.0f) * points_->pdf_area(point);
    return area_ > 0 ? 1.0f / emitting_area() : 0.0f;
  }
  float emission_pdf_direction(const SurfacePoint& point, const Vec3f& direction) const override {
    return cosine_hemisphere_pdf(dot(point.ng, direction));
  }

  /// Of a light with two sides on either of them: the normal of the point tells which.
  EmissionSample sample_origin(const Vec2f& u) const override {
    const bool behind = traits_.is_two_sided && u.x < 0.5f;
    const float u_area = !traits_.is_two_sided ? u.x : rescaled(u.x, behind ? 0.0f : 0.5f, 0.5f);
    const ShapeSample s =
        points_ ? points_->sample({u_area, u.y}) : shape_->sample_area({u_area, u.y});
    EmissionSample result;
    if (!(s.pdf_area > 0)) return result;
    result.point = placed(s.point);
    if (behind) {
      result.point.ng = -result.point.ng;
      result.point.ns = -result.point.ns;
    }
    result.on_surface = true;
    result.pdf_position = traits_.is_two_sided ? 0.5f * s.pdf_area : s.pdf_area;
    return result;
  }

 private:
  ShapeSample sample_by_geometry(const LightQuery& query, const Vec2f& u,
                                 float& pdf_solid_angle) const {
    return faces_ ? faces_->sample_toward(query, u, pdf_solid_angle)
                  : shape_->sample_toward(query.reference, u, pdf_solid_angle);
  }
  float pdf_by_geometry(const LightQuery& query, const SurfacePoint& point) const {
    return faces_ ? faces_->pdf_toward(query, point) : shape_->pdf_toward(query.reference, point);
  }
  /// One half each, with the density of both.
  ShapeSample sample_by_pattern(const LightQuery& query, const Vec2f& u,
                                float& pdf_solid_angle) const {
    ShapeSample s;
    float by_pattern = 0, by_geometry = 0;
    if (u.x < 0.5f) {
      s = points_->sample({rescaled(u.x, 0.0f, 0.5f), u.y});
      if (!(s.pdf_area > 0)) return s;
      by_pattern = s.pdf_area;
      by_geometry = pdf_by_geometry(query, s.point);
    } else {
      s = sample_by_geometry(query, {rescaled(u.x, 0.5f, 0.5f), u.y}, by_geometry);
      if (!(by_geometry > 0)) return s;
      by_pattern = points_->pdf_area(s.point);
    }
    pdf_solid_angle =
        0.5f * (by_geometry + solid_angle_density(query.reference, s.point, by_pattern));
    return s;
  }

  Spectrum radiance_at(const SurfacePoint& point, const Wavelengths& wavelengths) const {
    return pattern_ ? pattern_->radiance(point, wavelengths) * scale_ : radiance_.at(wavelengths);
  }
  float emitting_area() const { return traits_.is_two_sided ? 2.0f * area_ : area_; }
  /// A point of the shape as a point of the scene.
  SurfacePoint placed(SurfacePoint point) const {
    if (traits_.shape >= 0) point.shape = uint32_t(traits_.shape);
    return point;
  }

  SpectralValue radiance_;  ///< with a pattern: its mean
  std::shared_ptr<const EmissionPattern> pattern_;
  float scale_;
  std::shared_ptr<const Shape> shape_;
  // Of many lights none is in a cache: what samples ask for lies together.
  std::unique_ptr<const MeshFaces> faces_;       ///< of meshes of more than a few triangles
  std::unique_ptr<const PatternPoints> points_;  ///< of patterns on shapes that a table fits
  float area_;
};

std::unique_ptr<Light> create_area(const LightInputs& inputs) {
  const Place place = inputs.arguments.place();
  if (!inputs.shape)
    throw Error(ErrorKind::input, "emitter 'area' stands outside of a shape",
                "put it inside of the shape that shall emit", place);
  if (!inputs.shape->can_sample())
    throw Error(ErrorKind::input, "this shape cannot be a light: no points can be sampled on it",
                "use another shape for the light", place);
  const Arguments& arguments = inputs.arguments;
  const SpectralValue radiance =
      inputs.pattern ? SpectralValue().with_rgb(mean_radiance(*inputs.pattern, *inputs.shape))
                     : emission_argument(inputs, "radiance");
  return with_finite_power(
      std::make_unique<AreaLight>(radiance, inputs.pattern, float(arguments.number("scale")),
                                  inputs.shape, inputs.shape_index, arguments.boolean("two_sided"),
                                  int(arguments.integer("shadow_samples"))),
      inputs);
}

}  // namespace

LightType area_light_type() {
  static const TypeInfo info{
      "emitter",
      "area",
      "Diffuse emission of the shape that holds it, on the side of the normal.",
      {color_parameter("radiance", 1, "Emitted radiance. With a texture it varies over the shape.")
           .in("W/(sr·m²)")
           .textured(),
       number_parameter("scale", 1, "Factor on the radiance.").range(0, 1e30),
       boolean_parameter("two_sided", false, "Makes the back emit like the front."),
       shadow_samples_parameter(), visible_parameter(), ignored_sampling_weight()}};
  return {info, true, create_area};
}

}  // namespace kaustik
