// The sphere. All arithmetic is in double precision: points are as near to the true surface as
// floats can be, whatever the radius and the distance from the origin.

#include <array>
#include <map>

#include "kaustik/base/fast_math.h"
#include "kaustik/base/warp.h"
#include "kaustik/geometry/make_sphere.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"

namespace kaustik {
namespace {

class Sphere : public Shape {
 public:
  /// `axes`: unit, what the sphere's own x, y, z are in the world (for texture coordinates).
  Sphere(const Vec3d& center, double radius, const std::array<Vec3d, 3>& axes, bool flipped)
      : center_(center),
        radius_(radius),
        axes_{Vec3f(axes[0]), Vec3f(axes[1]), Vec3f(axes[2])},
        side_(flipped ? -1.0f : 1.0f) {}

  Bounds3f bounds() const override {
    const Vec3d r(radius_, radius_, radius_);
    return rounded_outward(center_ - r, center_ + r);
  }
  float area() const override { return float(4 * std::numbers::pi * radius_ * radius_); }
  std::optional<ShapeHit> intersect(const Ray& ray) const override;
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  UvDerivatives uv_derivatives(const SurfacePoint& at) const override;
  ShapeSample sample_area(const Vec2f& u) const override;
  std::optional<Vec2f> area_coordinates(const SurfacePoint& point) const override;
  ShapeSample sample_toward(const Vec3f& reference, const Vec2f& u,
                            float& pdf_solid_angle) const override;
  float pdf_toward(const Vec3f& reference, const SurfacePoint& point) const override;
  TriangleMesh tessellate(int level) const override;
  std::vector<Bounds3f> bounding_boxes(int budget) const override;

 private:
  SurfacePoint point_at(const Vec3d& unit) const;
  /// 1 − cos of the half angle of the cone that the sphere fills, seen from a point at the given
  /// squared distance of its centre; 0 where there is no such cone: from inside, and for all
  /// spheres that face inward, which are seen from inside only (a point on the sphere itself would
  /// seem to be outside half of the time, by rounding).
  double one_minus_cos(double distance_sq) const;
  std::vector<Bounds3f> surface_cells(int resolution) const;

  Vec3d center_;
  double radius_;
  Vec3f axes_[3];
  float side_;  ///< −1: normals point inward
};

std::optional<ShapeHit> Sphere::intersect(const Ray& ray) const {
  const Vec3d d(ray.direction);
  const Vec3d f = Vec3d(ray.origin) - center_;
  const double a = d.dot(d), b = -f.dot(d);
  // The discriminant by the distance of the line from the centre: no cancellation for spheres that
  // are small or far away (Haines et al., "Precision Improvements for Ray/Sphere Intersection",
  // Ray Tracing Gems 2019, eq. 5).
  const Vec3d nearest = f + d * (b / a);
  const double distance_sq = nearest.dot(nearest);
  const double discriminant = radius_ * radius_ - distance_sq;
  if (!(discriminant >= 0)) return std::nullopt;
  const double f_length = f.length();
  const double c = (f_length - radius_) * (f_length + radius_);
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  if (q == 0) return std::nullopt;
  const double t0 = std::min(c / q, q / a), t1 = std::max(c / q, q / a);
  const double t = t0 > 0 ? t0 : t1;
  if (!(t > 0) || !(t < double(ray.t_max))) return std::nullopt;
  return ShapeHit{float(t), 0, 0, Vec3f((f + d * t) * double(side_))};
}

SurfacePoint Sphere::point_at(const Vec3d& unit) const {
  const Vec3f n(unit);
  SurfacePoint point;
  point.position = Vec3f(center_ + unit * radius_);
  point.ng = n * side_;
  point.ns = point.ng;
  const Vec3f local(dot(n, axes_[0]), dot(n, axes_[1]), dot(n, axes_[2]));
  const float phi = approximate_atan2(local.y, local.x);
  const float theta = approximate_atan2(std::sqrt(local.x * local.x + local.y * local.y), local.z);
  point.uv = {(phi < 0 ? phi + 2 * pi : phi) * (0.5f * inv_pi), theta * inv_pi};
  point.error = position_rounding(point.position, n);
  return point;
}

SurfacePoint Sphere::surface_point(const Ray& ray, const Hit& hit) const {
  const Vec3d unit =
      (Vec3d(ray.origin) - center_ + Vec3d(ray.direction) * double(hit.t)).normalized();
  return point_at(unit);
}

UvDerivatives Sphere::uv_derivatives(const SurfacePoint& at) const {
  const Vec3f n = at.ng * side_;
  const Vec3f local(dot(n, axes_[0]), dot(n, axes_[1]), dot(n, axes_[2]));
  const float r = float(radius_), sin_theta = std::hypot(local.x, local.y);
  // At the poles any meridian serves.
  const float cos_phi = sin_theta > 0 ? local.x / sin_theta : 1;
  const float sin_phi = sin_theta > 0 ? local.y / sin_theta : 0;
  return {(axes_[1] * local.x - axes_[0] * local.y) * (2 * pi * r),
          ((axes_[0] * cos_phi + axes_[1] * sin_phi) * local.z - axes_[2] * sin_theta) * (pi * r)};
}

ShapeSample Sphere::sample_area(const Vec2f& u) const {
  return {point_at(Vec3d(square_to_sphere(u)).normalized()), 1.0f / area()};
}

std::optional<Vec2f> Sphere::area_coordinates(const SurfacePoint& point) const {
  const Vec3d unit = (Vec3d(point.position) - center_).normalized();
  const double turn = std::atan2(unit.y, unit.x) / (2 * std::numbers::pi);
  return Vec2f(float(0.5 * (1 - unit.z)), float(turn < 0 ? turn + 1 : turn));
}

double Sphere::one_minus_cos(double distance_sq) const {
  const double sin_sq = radius_ * radius_ / distance_sq;
  if (side_ < 0 || !(sin_sq < 1)) return 0;
  return sin_sq / (1 + std::sqrt(1 - sin_sq));
}

ShapeSample Sphere::sample_toward(const Vec3f& reference, const Vec2f& u,
                                  float& pdf_solid_angle) const {
  const Vec3d to_center = center_ - Vec3d(reference);
  const double distance_sq = to_center.length2();
  const double h_max = one_minus_cos(distance_sq);
  if (h_max == 0) return Shape::sample_toward(reference, u, pdf_solid_angle);
  // Angle θ at the reference → angle α at the centre, both from the axis between the two.
  const double h = double(u.x) * h_max, cos_theta = 1 - h, sin_theta_sq = h * (2 - h);
  const double sin_max_sq = radius_ * radius_ / distance_sq;
  const double cos_alpha = sin_theta_sq / std::sqrt(sin_max_sq) +
                           cos_theta * std::sqrt(std::max(0.0, 1 - sin_theta_sq / sin_max_sq));
  const double sin_alpha = std::sqrt(std::max(0.0, 1 - cos_alpha * cos_alpha));
  const double phi = 2 * std::numbers::pi * double(u.y);
  const Vec3d z = -to_center / std::sqrt(distance_sq);
  const Vec3d x = orthogonal_to(z), y = z.cross(x);
  const Vec3d unit =
      (x * (sin_alpha * std::cos(phi)) + y * (sin_alpha * std::sin(phi)) + z * cos_alpha)
          .normalized();
  pdf_solid_angle = float(1 / (2 * std::numbers::pi * h_max));
  ShapeSample sample{point_at(unit), 0};
  const Vec3d to_point = center_ + unit * radius_ - Vec3d(reference);
  const double cosine = std::fabs(to_point.dot(unit)) / to_point.length();
  sample.pdf_area = float(double(pdf_solid_angle) * cosine / to_point.length2());
  return sample;
}

float Sphere::pdf_toward(const Vec3f& reference, const SurfacePoint& point) const {
  const double h_max = one_minus_cos((center_ - Vec3d(reference)).length2());
  if (h_max == 0) return Shape::pdf_toward(reference, point);
  return float(1 / (2 * std::numbers::pi * h_max));
}

TriangleMesh Sphere::tessellate(int level) const {
  // An icosahedron, each triangle divided into four `level` times.
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3d> units = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                              {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                              {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3d& unit : units) unit.normalize();
  std::vector<std::array<uint32_t, 3>> triangles = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int i = 0; i < std::clamp(level, 0, 8); ++i) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), uint32_t(units.size()));
      if (is_new) units.push_back((units[a] + units[b]).normalized());
      return it->second;
    };
    std::vector<std::array<uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  TriangleMesh mesh;
  for (const Vec3d& unit : units) {
    mesh.positions.push_back(Vec3f(center_ + unit * radius_));
    mesh.normals.push_back(Vec3f(unit) * side_);
  }
  if (side_ < 0)
    for (auto& corner : triangles) std::swap(corner[1], corner[2]);
  mesh.triangles = std::move(triangles);
  return mesh;
}

std::vector<Bounds3f> Sphere::surface_cells(int resolution) const {
  std::vector<Bounds3f> cells;
  const double width = 2.0 / resolution;
  const Bounds3f whole = bounds();
  for (int i = 0; i < resolution; ++i)
    for (int j = 0; j < resolution; ++j)
      for (int k = 0; k < resolution; ++k) {
        double nearest_sq = 0, farthest_sq = 0;
        Vec3d low(i, j, k);
        low = low * width - Vec3d(1, 1, 1);
        const Vec3d high = low + Vec3d(width, width, width);
        for (int axis = 0; axis < 3; ++axis) {
          const double a = low[axis], b = high[axis];
          const double nearest = a > 0 ? a : b < 0 ? -b : 0;
          nearest_sq += nearest * nearest;
          farthest_sq += std::max(a * a, b * b);
        }
        if (nearest_sq <= 1 + 1e-9 && farthest_sq >= 1 - 1e-9)
          cells.push_back(common_part(
              rounded_outward(center_ + low * radius_, center_ + high * radius_), whole));
      }
  return cells;
}

std::vector<Bounds3f> Sphere::bounding_boxes(int budget) const {
  std::vector<Bounds3f> best = {bounds()};
  for (int resolution = 2; resolution <= 64; ++resolution) {
    std::vector<Bounds3f> cells = surface_cells(resolution);
    if (cells.size() > size_t(std::max(1, budget))) break;
    best = std::move(cells);
  }
  return best;
}

}  // namespace

const TypeInfo& sphere_info() {
  static const TypeInfo info{
      "shape",
      "sphere",
      "A sphere; rays meet it exactly.",
      {point_parameter("center", Vec3d(0, 0, 0), "Centre of the sphere."),
       number_parameter("radius", 1.0, "Radius of the sphere.")
           .range(smallest_length, largest_length)
           .in("m"),
       to_world_parameter("Places the sphere in the world; one scale for all axes."),
       boolean_parameter("flip_normals", false, "The inside is the front.")}};
  return info;
}

std::unique_ptr<Shape> make_sphere(const Vec3d& center, double radius) {
  const std::array<Vec3d, 3> axes = {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};
  return std::make_unique<Sphere>(center, radius, axes, false);
}

std::unique_ptr<Shape> create_sphere(const Arguments& arguments) {
  const double scale = similarity_scale(arguments);
  const Transform& to_world = arguments.transform("to_world");
  const std::array<Vec3d, 3> axes = {transform_vector(to_world, {1, 0, 0}).normalized(),
                                     transform_vector(to_world, {0, 1, 0}).normalized(),
                                     transform_vector(to_world, {0, 0, 1}).normalized()};
  return std::make_unique<Sphere>(transform_point(to_world, arguments.point("center")),
                                  arguments.number("radius") * scale, axes,
                                  arguments.boolean("flip_normals"));
}

}  // namespace kaustik
