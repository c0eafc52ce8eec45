#include "kaustik/base/warp.h"
#include "tests/light/light_testing.h"

namespace kaustik::testing {
namespace {

/// Sampled by area; the subclasses only say where.
class AreaSampledShape : public Shape {
 public:
  ShapeSample sample_toward(const Vec3f& reference, const Vec2f& u,
                            float& pdf_solid_angle) const override {
    const ShapeSample s = sample_area(u);
    pdf_solid_angle = pdf_toward(reference, s.point);
    return s;
  }
  float pdf_toward(const Vec3f& reference, const SurfacePoint& point) const override {
    const Vec3f way = reference - point.position;
    const float cosine = abs_dot(way, point.ng) / length(way);
    return cosine > 0 ? length_sq(way) / (cosine * area()) : 0.0f;
  }
  TriangleMesh tessellate(int) const override { return mesh() ? *mesh() : TriangleMesh{}; }

 protected:
  static SurfacePoint plain_point(const Vec3f& position, const Vec3f& normal) {
    SurfacePoint point;
    point.position = position;
    point.ng = point.ns = normal;
    point.dpdu = Vec3f(0, 0, 0);
    point.uv = Vec2f(0, 0);
    return point;
  }
};

class Quad final : public AreaSampledShape {
 public:
  Quad(const Vec3f& corner, const Vec3f& a, const Vec3f& b)
      : corner_(corner), a_(a), b_(b), normal_(normalize(cross(a, b))) {
    mesh_.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh_.triangles = {{0, 1, 2}, {0, 2, 3}};
  }
  const TriangleMesh* mesh() const override { return &mesh_; }
  Bounds3f bounds() const override {
    Bounds3f b;
    for (const Vec3f& p : mesh_.positions) b.extendBy(p);
    return b;
  }
  float area() const override { return length(cross(a_, b_)); }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override {
    return plain_point(ray.origin + ray.direction * hit.t, normal_);
  }
  ShapeSample sample_area(const Vec2f& u) const override {
    ShapeSample s{plain_point(corner_ + a_ * u.x + b_ * u.y, normal_), 1.0f / area()};
    s.point.uv = u;
    s.point.primitive = u.x > u.y ? 0 : 1;
    return s;
  }

 private:
  Vec3f corner_, a_, b_, normal_;
  TriangleMesh mesh_;
};

class Disk final : public AreaSampledShape {
 public:
  Disk(const Vec3f& center, const Vec3f& normal, float radius)
      : center_(center), frame_(normal), radius_(radius) {}
  Bounds3f bounds() const override {
    const Vec3f r(radius_ * safe_sqrt(1 - sqr(frame_.z.x)),
                  radius_ * safe_sqrt(1 - sqr(frame_.z.y)),
                  radius_ * safe_sqrt(1 - sqr(frame_.z.z)));
    return {center_ - r, center_ + r};
  }
  float area() const override { return pi * sqr(radius_); }
  std::optional<ShapeHit> intersect(const Ray& ray) const override {
    const float t = dot(center_ - ray.origin, frame_.z) / dot(ray.direction, frame_.z);
    if (!(t > 0 && t < ray.t_max)) return std::nullopt;
    if (length_sq(ray.origin + ray.direction * t - center_) > sqr(radius_)) return std::nullopt;
    return ShapeHit{t, 0, 0, frame_.z};
  }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override {
    return plain_point(ray.origin + ray.direction * hit.t, frame_.z);
  }
  ShapeSample sample_area(const Vec2f& u) const override {
    const Vec2f p = square_to_disk(u) * radius_;
    return {plain_point(center_ + frame_.to_world({p.x, p.y, 0}), frame_.z), 1.0f / area()};
  }

 private:
  Vec3f center_;
  Frame frame_;
  float radius_;
};

class Ball final : public AreaSampledShape {
 public:
  Ball(const Vec3f& center, float radius) : center_(center), radius_(radius) {}
  Bounds3f bounds() const override { return {center_ - Vec3f(radius_), center_ + Vec3f(radius_)}; }
  float area() const override { return 4 * pi * sqr(radius_); }
  std::optional<ShapeHit> intersect(const Ray& ray) const override {
    const Vec3f away = ray.origin - center_;
    const float b = dot(away, ray.direction);
    const float root = b * b - length_sq(away) + sqr(radius_);
    const float t = -b - safe_sqrt(root);
    if (root < 0 || !(t > 0 && t < ray.t_max)) return std::nullopt;
    return ShapeHit{t, 0, 0, away + ray.direction * t};
  }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override {
    return plain_point(ray.origin + ray.direction * hit.t, normalize(hit.ng));
  }
  ShapeSample sample_area(const Vec2f& u) const override {
    const Vec3f n = square_to_sphere(u);
    return {plain_point(center_ + n * radius_, n), 1.0f / area()};
  }
  ShapeSample sample_toward(const Vec3f& reference, const Vec2f& u,
                            float& pdf_solid_angle) const override {
    const Frame frame(normalize(center_ - reference));
    const Ray ray{reference, frame.to_world(square_to_cone(u, cone(reference)))};
    pdf_solid_angle = cone_pdf(cone(reference));
    const auto hit = intersect(ray);
    const float t = hit ? hit->t : dot(center_ - reference, ray.direction);
    const Vec3f position = ray.origin + ray.direction * t;
    return {plain_point(position, normalize(position - center_)), 1.0f / area()};
  }
  float pdf_toward(const Vec3f& reference, const SurfacePoint&) const override {
    return cone_pdf(cone(reference));
  }

 private:
  /// 1 − cos of the angular radius, the reference being outside.
  float cone(const Vec3f& reference) const {
    const float sin_sq = sqr(radius_) / length_sq(center_ - reference);
    return sin_sq / (1 + safe_sqrt(1 - sin_sq));
  }
  Vec3f center_;
  float radius_;
};

/// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
bool hit_triangle(const TriangleMesh& mesh, uint32_t index, const Ray& ray, Hit& hit) {
  const auto& [i, j, k] = mesh.triangles[index];
  const Vec3f a = mesh.positions[j] - mesh.positions[i], b = mesh.positions[k] - mesh.positions[i];
  const Vec3f p = cross(ray.direction, b), s = ray.origin - mesh.positions[i];
  const float inv = 1.0f / dot(a, p);
  const float u = dot(s, p) * inv;
  const Vec3f q = cross(s, a);
  const float v = dot(ray.direction, q) * inv, t = dot(b, q) * inv;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < hit.t)) return false;
  hit.t = t;
  hit.u = u;
  hit.v = v;
  hit.ng = cross(a, b);
  hit.primitive = index;
  return true;
}

}  // namespace

std::shared_ptr<const Shape> make_quad(const Vec3f& corner, const Vec3f& a, const Vec3f& b) {
  return std::make_shared<Quad>(corner, a, b);
}
std::shared_ptr<const Shape> make_disk(const Vec3f& center, const Vec3f& normal, float radius) {
  return std::make_shared<Disk>(center, normal, radius);
}
std::shared_ptr<const Shape> make_ball(const Vec3f& center, float radius) {
  return std::make_shared<Ball>(center, radius);
}

std::optional<SurfacePoint> first_hit(const Shape& shape, const Ray& ray) {
  Hit hit;
  hit.t = ray.t_max;
  if (const TriangleMesh* mesh = shape.mesh()) {
    bool found = false;
    for (uint32_t i = 0; i < mesh->triangles.size(); ++i) found |= hit_triangle(*mesh, i, ray, hit);
    if (!found) return std::nullopt;
  } else {
    const auto own = shape.intersect(ray);
    if (!own) return std::nullopt;
    hit.t = own->t;
    hit.u = own->u;
    hit.v = own->v;
    hit.ng = own->ng;
  }
  return shape.surface_point(ray, hit);
}

}  // namespace kaustik::testing
