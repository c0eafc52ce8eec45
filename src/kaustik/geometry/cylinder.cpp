// The open cylinder: no caps. Under an uneven transform its base is an ellipse, which may lean.
// Double precision inside, as the sphere.

#include <fmt/format.h>

#include "kaustik/base/to_integer.h"
#include "kaustik/geometry/elliptic_integral.h"
#include "kaustik/geometry/linear_map.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"

namespace kaustik {
namespace {

/// The points base + radius (x cos φ + y sin φ) + h z with h from 0 to length.
struct CylinderFrame {
  Vec3d base, x, y, z;
  double length = 1, radius = 1;
};

class Cylinder : public Shape {
 public:
  /// A right circular cylinder, whose x, y and z are unit and orthogonal.
  static std::unique_ptr<Cylinder> circular(const CylinderFrame& frame, bool flipped) {
    std::unique_ptr<Cylinder> cylinder(new Cylinder(frame, flipped));
    cylinder->is_circular_ = true;
    for (size_t i = 0; i < 3; ++i) cylinder->map_.duals[i] = cylinder->map_.columns[i];
    cylinder->girth_ = 2 * std::numbers::pi * frame.radius;
    cylinder->axis_length_ = frame.length;
    return cylinder;
  }
  /// Any other, of length and radius 1.
  static std::unique_ptr<Cylinder> skewed(const CylinderFrame& frame, bool flipped) {
    std::unique_ptr<Cylinder> cylinder(new Cylinder(frame, flipped));
    cylinder->measure();
    return cylinder;
  }

  Bounds3f bounds() const override { return part_bounds(0, length_); }
  float area() const override { return float(girth_ * axis_length_); }
  std::optional<ShapeHit> intersect(const Ray& ray) const override;
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  UvDerivatives uv_derivatives(const SurfacePoint& at) const override {
    const Vec3d n(at.ng * side_);
    const double x = n.dot(map_.columns[0]), y = n.dot(map_.columns[1]), r = std::hypot(x, y);
    return {
        Vec3f((map_.columns[1] * x - map_.columns[0] * y) * (2 * std::numbers::pi * radius_ / r)),
        Vec3f(map_.columns[2] * length_)};
  }
  ShapeSample sample_area(const Vec2f& u) const override;
  TriangleMesh tessellate(int level) const override;
  std::vector<Bounds3f> bounding_boxes(int budget) const override;

 private:
  Cylinder(const CylinderFrame& frame, bool flipped)
      : base_(frame.base),
        map_({frame.x, frame.y, frame.z}),
        length_(frame.length),
        radius_(frame.radius),
        side_(flipped ? -1.0f : 1.0f) {}

  void measure();
  /// (x, y): unit, around the axis; z: along it, from 0 to length_.
  SurfacePoint point_at(double x, double y, double z) const;
  Vec3d position(double x, double y, double z) const {
    return base_ + map_.columns[0] * x + map_.columns[1] * y + map_.columns[2] * z;
  }
  Vec3d normal(double x, double y) const {
    const Vec3d n = map_.duals[0] * x + map_.duals[1] * y;
    return is_circular_ ? n : n.normalized();
  }
  /// How fast the base is gone round at that angle, across the axis; per radian.
  double speed(double x, double y) const {
    return (map_.columns[1] * x - map_.columns[0] * y).cross(map_.columns[2]).length() /
           axis_length_;
  }
  /// Of the full turns between two heights.
  Bounds3f part_bounds(double z0, double z1) const;
  /// Of one of `around` equal sectors (at least 3) between two heights.
  Bounds3f patch_bounds(int sector, int around, double z0, double z1) const;

  Vec3d base_;
  LinearMap map_;
  double length_, radius_;
  float side_;
  bool is_circular_ = false;
  double girth_ = 0, axis_length_ = 0;  ///< across and along the axis, m
  double most_speed_ = 0;
};

/// The ellipse across the axis.
void Cylinder::measure() {
  axis_length_ = map_.columns[2].length();
  const Vec3d z = map_.columns[2] / axis_length_;
  const Vec3d a = map_.columns[0] - z * z.dot(map_.columns[0]);
  const Vec3d b = map_.columns[1] - z * z.dot(map_.columns[1]);
  // Of conjugate half diameters the squares add up to those of the half axes, and the areas agree.
  const double half_sum = 0.5 * (a.length2() + b.length2()), area = a.cross(b).length();
  const double difference = std::sqrt(std::max(0.0, (half_sum - area) * (half_sum + area)));
  const double longest_sq = half_sum + difference;
  girth_ = 8 * carlson_rg(0, longest_sq, area / longest_sq * area);
  most_speed_ = (1 + 1e-9) * std::sqrt(longest_sq);
}

ShapeSample Cylinder::sample_area(const Vec2f& u) const {
  const auto at = [&](float turns) {
    const double phi = 2 * std::numbers::pi * double(turns);
    return Imath::V2d(std::cos(phi), std::sin(phi));
  };
  Imath::V2d unit = at(u.x);
  if (!is_circular_) {
    // Uniform in the angle, and taken as often as the base is long there: at least in 2/π of all
    // tries.
    FurtherNumbers further(u);
    for (int i = 0; i < most_draws; ++i) {
      if (double(further.next()) * most_speed_ < speed(unit.x, unit.y)) break;
      unit = at(further.next());
    }
  }
  return {point_at(unit.x, unit.y, double(u.y) * length_), 1.0f / area()};
}

std::optional<ShapeHit> Cylinder::intersect(const Ray& ray) const {
  const Vec3d d(ray.direction), f = Vec3d(ray.origin) - base_;
  const auto& [x_dual, y_dual, z_dual] = map_.duals;
  const double fx = f.dot(x_dual), fy = f.dot(y_dual), dx = d.dot(x_dual), dy = d.dot(y_dual);
  const double a = dx * dx + dy * dy, b = -(fx * dx + fy * dy);
  if (!(a > 0)) return std::nullopt;
  // As for the sphere, by the distance of the line from the axis.
  const double s = b / a, nx = fx + dx * s, ny = fy + dy * s;
  const double discriminant = radius_ * radius_ - (nx * nx + ny * ny);
  if (!(discriminant >= 0)) return std::nullopt;
  const double from_axis = std::hypot(fx, fy);
  const double c = (from_axis - radius_) * (from_axis + radius_);
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  if (q == 0) return std::nullopt;
  const double fz = f.dot(z_dual), dz = d.dot(z_dual);
  for (const double t : {std::min(c / q, q / a), std::max(c / q, q / a)}) {
    const double z = fz + dz * t;
    if (!(t > 0) || !(t < double(ray.t_max)) || !(z >= 0 && z <= length_)) continue;
    const double x = fx + dx * t, y = fy + dy * t;
    const Vec3d n = x_dual * x + y_dual * y;
    return ShapeHit{float(t), float(x), float(y), Vec3f(n * double(side_))};
  }
  return std::nullopt;
}

SurfacePoint Cylinder::surface_point(const Ray& ray, const Hit& hit) const {
  const Vec3d f = Vec3d(ray.origin) - base_ + Vec3d(ray.direction) * double(hit.t);
  // What rounding t does to x and y is much for a cylinder that is flat.
  const double x = is_circular_ ? f.dot(map_.duals[0]) : double(hit.u);
  const double y = is_circular_ ? f.dot(map_.duals[1]) : double(hit.v);
  const double r = std::hypot(x, y);
  return point_at(x / r, y / r, std::clamp(f.dot(map_.duals[2]), 0.0, length_));
}

SurfacePoint Cylinder::point_at(double x, double y, double z) const {
  const Vec3f n(normal(x, y));
  SurfacePoint point;
  point.position = Vec3f(position(x * radius_, y * radius_, z));
  point.ng = n * side_;
  point.ns = point.ng;
  const double phi = std::atan2(y, x);
  point.uv = {float((phi < 0 ? phi + 2 * std::numbers::pi : phi) / (2 * std::numbers::pi)),
              float(z / length_)};
  point.error = position_rounding(point.position, n);
  return point;
}

TriangleMesh Cylinder::tessellate(int level) const {
  const int n = 6 << std::clamp(level, 0, 12);
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * i / n, x = std::cos(phi), y = std::sin(phi);
    for (const double z : {0.0, length_}) {
      mesh.positions.push_back(Vec3f(position(radius_ * x, radius_ * y, z)));
      mesh.normals.push_back(Vec3f(normal(x, y)) * side_);
    }
    const auto a = uint32_t(2 * i), b = uint32_t(2 * ((i + 1) % n));
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  // x, y, z may be left-handed; and the inside may be the front.
  if ((map_.determinant() < 0) != (side_ < 0))
    for (auto& corner : mesh.triangles) std::swap(corner[1], corner[2]);
  return mesh;
}

Bounds3f Cylinder::part_bounds(double z0, double z1) const {
  Imath::Box3d box;
  for (const double z : {z0, z1}) {
    const Vec3d middle = position(0, 0, z);
    const auto half = [&](int i) {
      return radius_ * std::hypot(map_.columns[0][i], map_.columns[1][i]);
    };
    const Vec3d extent(half(0), half(1), half(2));
    box.extendBy(middle - extent);
    box.extendBy(middle + extent);
  }
  return rounded_outward(box.min, box.max);
}

Bounds3f Cylinder::patch_bounds(int sector, int around, double z0, double z1) const {
  // An arc lies within the triangle of its ends and the meeting point of its tangents there.
  const double step = 2 * std::numbers::pi / around, phi0 = step * sector;
  const double tip = radius_ / std::cos(0.5 * step);
  Imath::Box3d box;
  for (const double z : {z0, z1}) {
    for (const double phi : {phi0, phi0 + step})
      box.extendBy(position(radius_ * std::cos(phi), radius_ * std::sin(phi), z));
    const double middle = phi0 + 0.5 * step;
    box.extendBy(position(tip * std::cos(middle), tip * std::sin(middle), z));
  }
  return rounded_outward(box.min, box.max);
}

std::vector<Bounds3f> Cylinder::bounding_boxes(int budget) const {
  // Patches about as long as wide; a thin cylinder is only cut along its axis.
  const int boxes = std::max(1, budget);
  int around = to_integer(std::sqrt(boxes * girth_ / axis_length_), 0, boxes);
  if (around < 4) around = 1;
  const int along = std::max(1, boxes / around);
  std::vector<Bounds3f> result;
  for (int i = 0; i < along; ++i) {
    const double z0 = length_ * i / along, z1 = length_ * (i + 1) / along;
    const Bounds3f part = part_bounds(z0, z1);
    if (around == 1) result.push_back(part);
    for (int j = 0; around > 1 && j < around; ++j)
      result.push_back(common_part(patch_bounds(j, around, z0, z1), part));
  }
  return result;
}

/// The factor on the radius, if a circle across the axis stays one; then x and y are orthogonal to
/// one another and to z.
std::optional<double> circular_scale(const CylinderFrame& frame, const Transform& to_world) {
  if (const std::optional<double> scale = similarity_scale(to_world)) return scale;
  constexpr double tolerance = 1e-4;  // as similarity_scale() has it
  const double x = frame.x.length(), y = frame.y.length(), z = frame.z.length();
  const double scale = std::sqrt(x * y);
  const bool circular = std::fabs(x - scale) < tolerance * scale &&
                        std::fabs(frame.x.dot(frame.y)) < tolerance * x * y &&
                        std::fabs(frame.x.dot(frame.z)) < tolerance * x * z &&
                        std::fabs(frame.y.dot(frame.z)) < tolerance * y * z;
  if (!circular) return std::nullopt;
  return scale;
}

/// The smallest of the distances between opposite tangents of the base, and of the ends.
double thickness_of(const CylinderFrame& frame) {
  const LinearMap map({frame.x, frame.y, frame.z});
  double most = 0;
  for (const Vec3d& dual : map.duals) most = std::max(most, dual.length());
  return 1 / most;
}

}  // namespace

const TypeInfo& cylinder_info() {
  static const TypeInfo info{
      "shape",
      "cylinder",
      "The side of a cylinder, without caps.",
      {point_parameter("p0", Vec3d(0, 0, 0), "One end of the axis."),
       point_parameter("p1", Vec3d(0, 0, 1), "The other end of the axis."),
       number_parameter("radius", 1.0, "Radius of the cylinder.")
           .range(smallest_length, largest_length)
           .in("m"),
       to_world_parameter("Places the cylinder in the world. It may make the base an ellipse and "
                          "let the axis lean."),
       boolean_parameter("flip_normals", false, "The inside is the front.")}};
  return info;
}

std::unique_ptr<Shape> create_cylinder(const Arguments& arguments) {
  const Transform& to_world = affine_to_world(arguments);
  const Vec3d axis = arguments.point("p1") - arguments.point("p0");
  if (!(axis.length() > 0))
    throw Error(ErrorKind::input, "shape 'cylinder': 'p0' and 'p1' are the same point",
                "move one of the two: they are the ends of the axis", arguments.place_of("p1"));
  const double radius = arguments.number("radius");
  const bool flipped = arguments.boolean("flip_normals");
  // Mitsuba's frame, so that u starts at the same side.
  const Frame frame(Vec3f(axis.normalized()));
  CylinderFrame made;
  made.base = transform_point(to_world, arguments.point("p0"));
  made.x = transform_vector(to_world, Vec3d(frame.x));
  made.y = transform_vector(to_world, Vec3d(frame.y));
  made.z = transform_vector(to_world, axis);
  if (const std::optional<double> scale = circular_scale(made, to_world)) {
    made.length = similarity_scale(to_world) ? axis.length() * *scale : made.z.length();
    made.radius = radius * *scale;
    made.z.normalize();
    made.x = (made.x - made.z * made.z.dot(made.x)).normalized();
    made.y = made.z.cross(made.x) * (to_world.determinant3() < 0 ? -1.0 : 1.0);
    return Cylinder::circular(made, flipped);
  }
  made.x *= radius;
  made.y *= radius;
  if (!(thickness_of(made) >= smallest_length))
    throw Error(ErrorKind::input,
                "shape 'cylinder': 'to_world' flattens it to less than single floats carry",
                fmt::format("let it be at least {:g} m thick", smallest_length),
                arguments.place_of("to_world"));
  return Cylinder::skewed(made, flipped);
}

}  // namespace kaustik
