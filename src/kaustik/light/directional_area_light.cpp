#include <algorithm>

#include "kaustik/geometry/ray_tracer.h"
#include "kaustik/light/light_kinds.h"
#include "kaustik/light/normal_cone.h"

namespace kaustik {
namespace {

/// Where a beam goes: the flat shape, and its bounds across its normal.
class Beam {
 public:
  Beam(std::shared_ptr<const Shape> shape, const Vec3f& normal)
      : frame_(normal), tracer_(Geometry{{std::move(shape)}, {}, {}}) {
    const Bounds3f bounds = tracer_.bounds();
    middle_ = center(bounds);
    for (int i = 0; i < 8; ++i) {
      const Vec3f corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                         i & 4 ? bounds.max.z : bounds.min.z);
      const Vec3f local = frame_.to_local(corner - middle_);
      half_size_.x = std::max(half_size_.x, std::fabs(local.x));
      half_size_.y = std::max(half_size_.y, std::fabs(local.y));
    }
    // So that rounding leaves out no point that find() answers.
    const float slack = 1e-5f * (max_abs(middle_) + half_size_.x + half_size_.y);
    half_size_ += Vec2f(slack, slack);
  }

  const Vec3f& direction() const { return frame_.z; }
  const Shape& shape() const { return tracer_.shape(0); }
  /// False only where find() finds nothing.
  bool may_reach(const Vec3f& position) const {
    const Vec3f local = frame_.to_local(position - middle_);
    return std::fabs(local.x) <= half_size_.x && std::fabs(local.y) <= half_size_.y;
  }
  /// The point of the shape from which light comes to `position`, and how far it is.
  bool find(const Vec3f& position, SurfacePoint& from, float& distance) const {
    const Ray back{position, -frame_.z, infinity};
    Hit hit;
    if (!tracer_.intersect(back, hit)) return false;
    from = tracer_.surface_point(back, hit);
    distance = hit.t;
    return dot(from.ng, frame_.z) > 0;
  }

 private:
  Frame frame_;  ///< z: the direction
  RayTracer tracer_;
  Vec3f middle_{0, 0, 0};
  Vec2f half_size_{0, 0};
};

/// Emits from every point of a flat shape along its normal alone, as Mitsuba's `directionalarea`:
/// what it calls radiance, W/m², goes through each m² of the beam, whatever the distance. So it is
/// a distant light that begins at a surface and ends at the beam's borders.
class DirectionalAreaLight final : public DistantLight {
 public:
  /// `pattern` may be null, else `radiance` is its mean.
  DirectionalAreaLight(const SpectralValue& radiance,
                       std::shared_ptr<const EmissionPattern> pattern,
                       std::shared_ptr<const Shape> shape, int shape_index, const Vec3f& normal)
      : radiance_(radiance),
        pattern_(std::move(pattern)),
        area_(shape->area()),
        beam_(std::move(shape), normal) {
    traits_.is_delta = true;
    traits_.beam_shape = shape_index;
    traits_.power = radiance.rgb() * area_;
    LightBounds& bounds = traits_.bounds;
    bounds.axis = normal;
    bounds.cos_angle = bounds.cos_spread = 1;
    bounds.infinite = true;
  }

  float expected_irradiance(const LightQuery& query) const override {
    if (!beam_.may_reach(query.reference)) return 0;
    return radiance_.rgb().sum() * receiver_cosine(query, -beam_.direction());
  }

  LightSample sample_toward(const LightQuery& query, const Vec2f&) const override {
    LightSample result;
    result.only_sampled = true;
    if (!beam_.may_reach(query.reference) ||
        !beam_.find(query.reference, result.point, result.distance))
      return result;
    result.point = placed(result.point);
    result.on_surface = true;
    result.direction = -beam_.direction();
    result.delta = true;
    result.radiance = radiance_at(result.point, query.wavelengths);
    result.pdf_solid_angle = 1;
    return result;
  }

  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }
  Spectrum background(const Vec3f&, const Wavelengths&) const override { return {}; }

  Spectrum emitted(const SurfacePoint& point, const Vec3f&,
                   const Wavelengths& wavelengths) const override {
    return radiance_at(point, wavelengths);
  }
  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f&,
                                 const Wavelengths& wavelengths) const override {
    EmissionSample result;
    const ShapeSample s = beam_.shape().sample_area(u_position);
    if (!(s.pdf_area > 0)) return result;
    result.point = placed(s.point);
    result.on_surface = true;
    result.direction = beam_.direction();
    result.pdf_position = s.pdf_area;
    result.pdf_direction = 1;
    result.flux = radiance_at(result.point, wavelengths) * (1.0f / s.pdf_area);
    return result;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 1.0f / area_; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f&) const override { return 1; }
  TravelDirection sample_travel_direction(const Vec2f&) const override {
    return {beam_.direction(), 1};
  }

 private:
  Spectrum radiance_at(const SurfacePoint& point, const Wavelengths& wavelengths) const {
    return pattern_ ? pattern_->radiance(point, wavelengths) : radiance_.at(wavelengths);
  }
  /// A point of the shape as a point of the scene.
  SurfacePoint placed(SurfacePoint point) const {
    if (traits_.beam_shape >= 0) point.shape = uint32_t(traits_.beam_shape);
    return point;
  }

  SpectralValue radiance_;  ///< with a pattern: its mean
  std::shared_ptr<const EmissionPattern> pattern_;
  float area_;
  Beam beam_;
};

/// Whether all vertices lie in one plane across `normal`.
bool is_in_plane(const TriangleMesh& mesh, const Vec3f& normal, const Bounds3f& bounds) {
  const Vec3d middle(center(bounds)), n(normal);
  double nearest = 0, farthest = 0;
  bool is_first = true;
  for (const auto& corners : mesh.triangles)
    for (const uint32_t corner : corners) {
      const double height = (Vec3d(mesh.positions[corner]) - middle).dot(n);
      nearest = is_first ? height : std::min(nearest, height);
      farthest = is_first ? height : std::max(farthest, height);
      is_first = false;
    }
  return farthest - nearest <= 1e-4 * double(bounding_radius(bounds));
}

/// The normal that all of the shape has.
Vec3f normal_of_flat(const Shape& shape, const Place& place) {
  const DirectionCone normals = cone_of_normals(shape);
  const TriangleMesh* mesh = shape.mesh();
  if (normals.cos_angle < 0.9999f || (mesh && !is_in_plane(*mesh, normals.axis, shape.bounds())))
    throw Error(ErrorKind::input,
                "emitter 'directionalarea' stands in a shape that is not flat: no point could tell "
                "from where it is lit",
                "put it into a rectangle, a disk or a flat mesh, or use emitter 'area'", place);
  return normals.axis;
}

std::unique_ptr<Light> create_directional_area(const LightInputs& inputs) {
  const Place place = inputs.arguments.place();
  if (!inputs.shape)
    throw Error(ErrorKind::input, "emitter 'directionalarea' stands outside of a shape",
                "put it inside of the shape that shall emit", place);
  if (!inputs.shape->can_sample())
    throw Error(ErrorKind::input, "this shape cannot be a light: no points can be sampled on it",
                "use another shape for the light", place);
  const SpectralValue radiance =
      inputs.pattern ? SpectralValue().with_rgb(mean_radiance(*inputs.pattern, *inputs.shape))
                     : emission_argument(inputs, "radiance");
  return with_finite_power(std::make_unique<DirectionalAreaLight>(
                               radiance, inputs.pattern, inputs.shape, inputs.shape_index,
                               normal_of_flat(*inputs.shape, place)),
                           inputs);
}

}  // namespace

LightType directional_area_light_type() {
  static const TypeInfo info{"emitter",
                             "directionalarea",
                             "A beam of parallel light from the flat shape that holds it, along "
                             "its normal. Rays never hit it by chance.",
                             {color_parameter("radiance", 1,
                                              "Irradiance on a surface across the beam, as Mitsuba "
                                              "counts it. With a texture it varies over the shape.")
                                  .in("W/m²")
                                  .textured(),
                              ignored_sampling_weight()}};
  return {info, true, create_directional_area};
}

}  // namespace kaustik
