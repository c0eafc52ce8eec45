// The disk; an ellipse where `to_world` scales unevenly. Double precision inside, as the sphere.

#include "kaustik/base/warp.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"
#include "kaustik/geometry/spherical_rectangle.h"

namespace kaustik {
namespace {

class Disk : public Shape {
 public:
  /// The points center + x s + y t with x² + y² ≤ 1.
  Disk(const Vec3d& center, const Vec3d& s, const Vec3d& t, const Vec3d& normal)
      : center_(center), s_(s), t_(t), normal_(normal) {
    const Vec3d m = s.cross(t);
    dual_s_ = t.cross(m) / m.length2();
    dual_t_ = m.cross(s) / m.length2();
    area_ = float(std::numbers::pi * m.length());
    bounding_square_ = SphericalRectangle::make(center, s, t);
  }

  Bounds3f bounds() const override {
    const Vec3d half(std::hypot(s_.x, t_.x), std::hypot(s_.y, t_.y), std::hypot(s_.z, t_.z));
    return rounded_outward(center_ - half, center_ + half);
  }
  float area() const override { return area_; }

  std::optional<ShapeHit> intersect(const Ray& ray) const override {
    const Vec3d d(ray.direction), f = Vec3d(ray.origin) - center_;
    const double t = -f.dot(normal_) / d.dot(normal_);
    if (!(t > 0) || !(t < double(ray.t_max))) return std::nullopt;
    const Vec3d p = f + d * t;
    const double x = p.dot(dual_s_), y = p.dot(dual_t_);
    if (!(x * x + y * y <= 1)) return std::nullopt;
    return ShapeHit{float(t), float(x), float(y), Vec3f(normal_)};
  }

  SurfacePoint surface_point(const Ray&, const Hit& hit) const override {
    return point_at(hit.u, hit.v);
  }

  UvDerivatives uv_derivatives(const SurfacePoint& at) const override {
    const double r = double(at.uv.x), phi = 2 * std::numbers::pi * double(at.uv.y);
    return {Vec3f(s_ * std::cos(phi) + t_ * std::sin(phi)),
            Vec3f(t_ * std::cos(phi) - s_ * std::sin(phi)) * float(2 * std::numbers::pi * r)};
  }

  ShapeSample sample_area(const Vec2f& u) const override {
    const Vec2f d = square_to_disk(u);
    return {point_at(d.x, d.y), area_ > 0 ? 1.0f / area_ : 0.0f};
  }

  std::optional<Vec2f> area_coordinates(const SurfacePoint& point) const override {
    const Vec3d from_center = Vec3d(point.position) - center_;
    const Vec2f u =
        disk_to_square({float(from_center.dot(dual_s_)), float(from_center.dot(dual_t_))});
    return Vec2f(std::clamp(u.x, 0.0f, 1.0f), std::clamp(u.y, 0.0f, 1.0f));
  }

  /// From nearby a direction to the square about the disk, whose corners are no light.
  ShapeSample sample_toward(const Vec3f& reference, const Vec2f& u,
                            float& pdf_solid_angle) const override {
    const auto square = seen_near(reference);
    if (!square) return Shape::sample_toward(reference, u, pdf_solid_angle);
    const Vec2f at = square->sample(u);
    const bool inside = at.x * at.x + at.y * at.y <= 1;
    pdf_solid_angle = inside ? square->pdf() : 0.0f;
    return sample_of(point_at(at.x, at.y), reference, pdf_solid_angle);
  }
  float pdf_toward(const Vec3f& reference, const SurfacePoint& point) const override {
    const auto square = seen_near(reference);
    return square ? square->pdf() : Shape::pdf_toward(reference, point);
  }

  TriangleMesh tessellate(int level) const override;
  std::vector<Bounds3f> bounding_boxes(int budget) const override;

 private:
  std::optional<SphericalRectangle::View> seen_near(const Vec3f& reference) const {
    // A fifth of the samples is lost in the corners: it has to be near for that to pay.
    constexpr double ratio = 1.2;
    return bounding_square_ ? bounding_square_->seen_near(reference, ratio) : std::nullopt;
  }

  SurfacePoint point_at(float x, float y) const {
    SurfacePoint point;
    point.position = Vec3f(center_ + s_ * double(x) + t_ * double(y));
    point.ng = point.ns = Vec3f(normal_);
    const float r = std::hypot(x, y);
    const float phi = std::atan2(y, x);
    point.uv = {r, (phi < 0 ? phi + 2 * pi : phi) * (0.5f * inv_pi)};
    point.error = position_rounding(point.position, point.ng);
    return point;
  }

  Vec3d center_, s_, t_, normal_;
  Vec3d dual_s_, dual_t_;  ///< take a point of the plane back to x and y
  float area_ = 0;
  std::optional<SphericalRectangle> bounding_square_;  ///< none for sheared disks
};

TriangleMesh Disk::tessellate(int level) const {
  const int n = 12 << std::clamp(level, 0, 12);
  const bool turned = s_.cross(t_).dot(normal_) < 0;
  TriangleMesh mesh;
  mesh.positions.push_back(Vec3f(center_));
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * i / n;
    mesh.positions.push_back(Vec3f(center_ + s_ * std::cos(phi) + t_ * std::sin(phi)));
    const auto a = uint32_t(1 + i), b = uint32_t(1 + (i + 1) % n);
    mesh.triangles.push_back(turned ? std::array{0u, b, a} : std::array{0u, a, b});
  }
  return mesh;
}

std::vector<Bounds3f> Disk::bounding_boxes(int budget) const {
  const int n = int(std::sqrt(std::max(1, budget)));
  const Bounds3f whole = bounds();
  std::vector<Bounds3f> boxes;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x0 = 2.0 * i / n - 1, x1 = 2.0 * (i + 1) / n - 1;
      const double y0 = 2.0 * j / n - 1, y1 = 2.0 * (j + 1) / n - 1;
      const double x = x0 > 0 ? x0 : x1 < 0 ? x1 : 0, y = y0 > 0 ? y0 : y1 < 0 ? y1 : 0;
      if (x * x + y * y > 1 + 1e-6) continue;
      Imath::Box3d box;
      for (const double cx : {x0, x1})
        for (const double cy : {y0, y1}) box.extendBy(center_ + s_ * cx + t_ * cy);
      boxes.push_back(common_part(rounded_outward(box.min, box.max), whole));
    }
  return boxes;
}

}  // namespace

const TypeInfo& disk_info() {
  static const TypeInfo info{
      "shape",
      "disk",
      "The unit disk in the xy plane, facing +z.",
      {to_world_parameter("Places the disk in the world. It may make it an ellipse.").leaving(2),
       boolean_parameter("flip_normals", false, "Makes the disk face -z.")}};
  return info;
}

std::unique_ptr<Shape> create_disk(const Arguments& arguments) {
  const Transform& to_world = affine_to_world(arguments);
  const Vec3d s = transform_vector(to_world, {1, 0, 0}), t = transform_vector(to_world, {0, 1, 0});
  const bool flip = arguments.boolean("flip_normals") != (to_world.determinant3() < 0);
  const Vec3d normal = s.cross(t).normalized() * (flip ? -1.0 : 1.0);
  return std::make_unique<Disk>(transform_point(to_world, {0, 0, 0}), s, t, normal);
}

}  // namespace kaustik
