#include "kaustik/geometry/shape.h"

#include "kaustik/geometry/shape_support.h"

namespace kaustik {

std::optional<ShapeHit> Shape::intersect(const Ray&) const { return std::nullopt; }

ShapeSample Shape::sample_toward(const Vec3f& reference, const Vec2f& u,
                                 float& pdf_solid_angle) const {
  ShapeSample sample = sample_area(u);
  pdf_solid_angle =
      sample.pdf_area > 0 ? solid_angle_density(reference, sample.point, sample.pdf_area) : 0.0f;
  return sample;
}

float Shape::pdf_toward(const Vec3f& reference, const SurfacePoint& point) const {
  return can_sample() ? solid_angle_density(reference, point, 1.0f / area()) : 0.0f;
}

float solid_angle_density(const Vec3f& reference, const SurfacePoint& point, float pdf_area) {
  const Vec3d to_point = Vec3d(point.position) - Vec3d(reference);
  const double distance_sq = to_point.dot(to_point);
  const double cosine_times_distance = std::fabs(to_point.dot(Vec3d(point.ng)));
  if (!(cosine_times_distance > 0)) return 0;
  const double density =
      double(pdf_area) * distance_sq * std::sqrt(distance_sq) / cosine_times_distance;
  return density < double(std::numeric_limits<float>::max()) ? float(density) : 0.0f;
}

ShapeSample sample_of(const SurfacePoint& point, const Vec3f& reference, float pdf_solid_angle) {
  const float per_area = solid_angle_density(reference, point, 1);
  return {point, per_area > 0 ? pdf_solid_angle / per_area : 0.0f};
}

Bounds3f rounded_outward(const Vec3d& low, const Vec3d& high) {
  Bounds3f bounds;
  for (int i = 0; i < 3; ++i) {
    const double slack =
        4 * double(float_rounding) * std::max(std::fabs(low[i]), std::fabs(high[i]));
    bounds.min[i] = std::nextafter(float(low[i] - slack), -infinity);
    bounds.max[i] = std::nextafter(float(high[i] + slack), infinity);
  }
  return bounds;
}

Bounds3f common_part(const Bounds3f& a, const Bounds3f& b) {
  Bounds3f result;
  for (int i = 0; i < 3; ++i) {
    result.min[i] = std::max(a.min[i], b.min[i]);
    result.max[i] = std::min(a.max[i], b.max[i]);
  }
  return result;
}

float position_rounding(const Vec3f& position, const Vec3f& unit_normal) {
  return 1.5f * float_rounding *
         (std::fabs(position.x * unit_normal.x) + std::fabs(position.y * unit_normal.y) +
          std::fabs(position.z * unit_normal.z));
}

Vec3d transform_point(const Transform& t, const Vec3d& p) {
  const auto row = [&](int i) {
    return t.at(i, 0) * p.x + t.at(i, 1) * p.y + t.at(i, 2) * p.z + t.at(i, 3);
  };
  return Vec3d(row(0), row(1), row(2)) / row(3);
}

Vec3d transform_vector(const Transform& t, const Vec3d& v) {
  const auto row = [&](int i) { return t.at(i, 0) * v.x + t.at(i, 1) * v.y + t.at(i, 2) * v.z; };
  return {row(0), row(1), row(2)};
}

Vec3d orthogonal_to(const Vec3d& unit) {
  const Vec3d other = std::fabs(unit.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  return (other - unit * unit.dot(other)).normalized();
}

const Transform& affine_to_world(const Arguments& arguments) {
  const Transform& t = arguments.transform("to_world");
  // Shapes take apart what stands above the last row: another factor than 1 there would be lost, or
  // mirror the shape unnoticed.
  if (t.at(3, 0) != 0 || t.at(3, 1) != 0 || t.at(3, 2) != 0 || std::fabs(t.at(3, 3) - 1) > 1e-6)
    throw Error(ErrorKind::input,
                "shape '" + arguments.info().name + "': 'to_world' is a projection",
                "the last row of the matrix has to be 0 0 0 1", arguments.place_of("to_world"));
  return t;
}

std::optional<double> similarity_scale(const Transform& t) {
  const Vec3d x = transform_vector(t, {1, 0, 0});
  const Vec3d y = transform_vector(t, {0, 1, 0});
  const Vec3d z = transform_vector(t, {0, 0, 1});
  const double scale = std::cbrt(std::fabs(t.determinant3()));
  constexpr double tolerance = 1e-4;  // what matrices written with five digits keep
  const double scale_sq = scale * scale;
  const bool even = std::fabs(x.length() - scale) < tolerance * scale &&
                    std::fabs(y.length() - scale) < tolerance * scale &&
                    std::fabs(z.length() - scale) < tolerance * scale;
  const bool orthogonal = std::fabs(x.dot(y)) < tolerance * scale_sq &&
                          std::fabs(y.dot(z)) < tolerance * scale_sq &&
                          std::fabs(z.dot(x)) < tolerance * scale_sq;
  if (!even || !orthogonal) return std::nullopt;
  return scale;
}

}  // namespace kaustik
