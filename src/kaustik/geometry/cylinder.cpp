// The open cylinder: no caps. Double precision inside, as the sphere.

#include <fmt/format.h>

#include "kaustik/base/to_integer.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"

namespace kaustik {
namespace {

class Cylinder : public Shape {
 public:
  /// x, y, z: unit, orthogonal; z runs along the axis.
  Cylinder(const Vec3d& base, const Vec3d& x, const Vec3d& y, const Vec3d& z, double length,
           double radius, bool flipped)
      : base_(base),
        x_(x),
        y_(y),
        z_(z),
        length_(length),
        radius_(radius),
        side_(flipped ? -1.0f : 1.0f) {}

  Bounds3f bounds() const override { return part_bounds(0, length_); }
  float area() const override { return float(2 * std::numbers::pi * radius_ * length_); }
  std::optional<ShapeHit> intersect(const Ray& ray) const override;
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  UvDerivatives uv_derivatives(const SurfacePoint& at) const override {
    const Vec3d n(at.ng * side_);
    return {Vec3f(z_.cross(n)) *
                float((x_.cross(y_).dot(z_) < 0 ? -2 : 2) * std::numbers::pi * radius_),
            Vec3f(z_ * length_)};
  }
  ShapeSample sample_area(const Vec2f& u) const override {
    const double phi = 2 * std::numbers::pi * double(u.x);
    return {point_at(std::cos(phi), std::sin(phi), double(u.y) * length_), 1.0f / area()};
  }
  TriangleMesh tessellate(int level) const override;
  std::vector<Bounds3f> bounding_boxes(int budget) const override;

 private:
  /// (x, y): unit, around the axis; z: along it, m.
  SurfacePoint point_at(double x, double y, double z) const;
  Vec3d position(double x, double y, double z) const { return base_ + x_ * x + y_ * y + z_ * z; }
  /// Of the full turns between two heights.
  Bounds3f part_bounds(double z0, double z1) const;
  /// Of one of `around` equal sectors (at least 3) between two heights.
  Bounds3f patch_bounds(int sector, int around, double z0, double z1) const;

  Vec3d base_, x_, y_, z_;
  double length_, radius_;
  float side_;
};

std::optional<ShapeHit> Cylinder::intersect(const Ray& ray) const {
  const Vec3d d(ray.direction), f = Vec3d(ray.origin) - base_;
  const double fx = f.dot(x_), fy = f.dot(y_), dx = d.dot(x_), dy = d.dot(y_);
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
  const double fz = f.dot(z_), dz = d.dot(z_);
  for (const double t : {std::min(c / q, q / a), std::max(c / q, q / a)}) {
    const double z = fz + dz * t;
    if (!(t > 0) || !(t < double(ray.t_max)) || !(z >= 0 && z <= length_)) continue;
    const Vec3d n = x_ * (fx + dx * t) + y_ * (fy + dy * t);
    return ShapeHit{float(t), 0, 0, Vec3f(n * double(side_))};
  }
  return std::nullopt;
}

SurfacePoint Cylinder::surface_point(const Ray& ray, const Hit& hit) const {
  const Vec3d f = Vec3d(ray.origin) - base_ + Vec3d(ray.direction) * double(hit.t);
  const double x = f.dot(x_), y = f.dot(y_), r = std::hypot(x, y);
  return point_at(x / r, y / r, std::clamp(f.dot(z_), 0.0, length_));
}

SurfacePoint Cylinder::point_at(double x, double y, double z) const {
  const Vec3f n(x_ * x + y_ * y);
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
      mesh.normals.push_back(Vec3f(x_ * x + y_ * y) * side_);
    }
    const auto a = uint32_t(2 * i), b = uint32_t(2 * ((i + 1) % n));
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  // x, y, z may be left-handed; and the inside may be the front.
  if ((x_.cross(y_).dot(z_) < 0) != (side_ < 0))
    for (auto& corner : mesh.triangles) std::swap(corner[1], corner[2]);
  return mesh;
}

Bounds3f Cylinder::part_bounds(double z0, double z1) const {
  Imath::Box3d box;
  for (const double z : {z0, z1}) {
    const Vec3d middle = position(0, 0, z);
    const auto half = [&](int i) { return radius_ * std::hypot(x_[i], y_[i]); };
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
  const double girth = 2 * std::numbers::pi * radius_;
  const int boxes = std::max(1, budget);
  int around = to_integer(std::sqrt(boxes * girth / length_), 0, boxes);
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
       to_world_parameter("Places the cylinder in the world; one scale for all axes."),
       boolean_parameter("flip_normals", false, "The inside is the front.")}};
  return info;
}

std::unique_ptr<Shape> create_cylinder(const Arguments& arguments) {
  const double scale = similarity_scale(arguments);
  const Transform& to_world = arguments.transform("to_world");
  const Vec3d axis = arguments.point("p1") - arguments.point("p0");
  if (!(axis.length() > 0))
    throw Error(ErrorKind::input, "shape 'cylinder': 'p0' and 'p1' are the same point",
                "move one of the two: they are the ends of the axis", arguments.place_of("p1"));
  // Mitsuba's frame, so that u starts at the same side.
  const Frame frame(Vec3f(axis.normalized()));
  const Vec3d z = transform_vector(to_world, axis).normalized();
  Vec3d x = transform_vector(to_world, Vec3d(frame.x));
  x = (x - z * z.dot(x)).normalized();
  const Vec3d y = z.cross(x) * (to_world.determinant3() < 0 ? -1.0 : 1.0);
  return std::make_unique<Cylinder>(transform_point(to_world, arguments.point("p0")), x, y, z,
                                    axis.length() * scale, arguments.number("radius") * scale,
                                    arguments.boolean("flip_normals"));
}

}  // namespace kaustik
