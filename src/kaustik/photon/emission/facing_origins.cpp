#include "kaustik/photon/emission/facing_origins.h"

#include "kaustik/base/warp.h"
#include "kaustik/geometry/mesh_surface.h"
#include "kaustik/photon/emission/aim_light.h"

namespace kaustik {
namespace {

/// Of larger meshes the sum over all triangles would cost more than rays that face away.
constexpr size_t maximum_faces = 64;

}  // namespace

FacingOrigins::FacingOrigins(const Light& light, const Shape* shape)
    : light_(&light), shape_(shape) {
  // Of two sides one faces any direction: none is better than another.
  if (!shape || light.traits().is_two_sided) return;
  ball_ = find_ball(*shape);
  const TriangleMesh* mesh = shape->mesh();
  if (!mesh || mesh->triangles.size() > maximum_faces) return;
  for (size_t i = 0; i < mesh->triangles.size(); ++i) {
    const auto [a, b, c] = mesh->triangles[i];
    const Vec3f p0 = mesh->positions[a], p1 = mesh->positions[b], p2 = mesh->positions[c];
    const Vec3f area = cross(p1 - p0, p2 - p0) * 0.5f;
    const Vec3f normal = triangle_normal(p0, p1, p2);
    if (length_sq(normal) > 0) faces_.push_back({normal * length(area), uint32_t(i)});
  }
}

float FacingOrigins::projected_area(const Vec3f& direction) const {
  float total = 0;
  for (const Face& face : faces_) total += std::max(dot(face.area_vector, direction), 0.0f);
  return total;
}

bool FacingOrigins::sample(const Vec3f& direction, const Vec2f& u, SurfacePoint& origin,
                           float& density) const {
  if (ball_.radius > 0 || !faces_.empty()) {
    if (!(ball_.radius > 0 ? sample_ball(direction, u, origin) : sample_mesh(direction, u, origin)))
      return false;
    density = pdf(origin, direction);
    return density > 0;
  }
  const EmissionSample sample = light_->placed().sample_origin(u);
  origin = sample.point;
  density = sample.pdf_position;
  return density > 0;
}

EmittedRay FacingOrigins::ray(const Vec3f& direction, float pdf_direction, const Vec2f& u,
                              const Wavelengths& wavelengths) const {
  EmittedRay result = no_ray();
  result.on_surface = shape_ != nullptr;
  SurfacePoint origin;
  if (!sample(direction, u, origin, result.pdf_position)) return result;
  float cosine = 1;
  if (result.on_surface) {
    result.origin = origin;
    result.ray = spawn_ray(origin, direction);
    cosine = dot(origin.ng, direction);
  } else {
    result.origin.position = origin.position;
    result.ray = {origin.position, direction};
  }
  if (!(cosine > 0)) return result;
  result.pdf_direction = pdf_direction;
  const float joint = result.pdf_position * pdf_direction;
  if (joint > 0) result.flux = light_->emitted(origin, direction, wavelengths) * (cosine / joint);
  return result;
}

float FacingOrigins::pdf(const SurfacePoint& origin, const Vec3f& direction) const {
  const float cosine = std::max(dot(origin.ng, direction), 0.0f);
  if (ball_.radius > 0) return cosine / (pi * sqr(ball_.radius));
  if (faces_.empty()) return light_->emission_pdf_position(origin);
  const float area = projected_area(direction);
  return area > 0 ? cosine / area : 0.0f;
}

bool FacingOrigins::sample_ball(const Vec3f& direction, const Vec2f& u,
                                SurfacePoint& origin) const {
  const Vec2f disk = square_to_disk(u);
  const float height = safe_sqrt(1.0f - sqr(disk.x) - sqr(disk.y));
  const Vec3f outward = Frame(direction).to_world(Vec3f(disk.x, disk.y, height));
  if (!point_of_ball(*shape_, ball_, outward, origin)) return false;
  origin.shape = uint32_t(light_->traits().shape);
  return true;
}

bool FacingOrigins::sample_mesh(const Vec3f& direction, Vec2f u, SurfacePoint& origin) const {
  float left = u.x * projected_area(direction);
  const Face* chosen = nullptr;
  float share = 0;
  for (const Face& face : faces_) {
    const float area = dot(face.area_vector, direction);
    if (!(area > 0)) continue;
    chosen = &face;
    share = left / area;
    if (left < area) break;
    left -= area;
  }
  if (!chosen) return false;
  const Vec2f b = square_to_triangle({std::clamp(share, 0.0f, one_minus_epsilon), u.y});
  origin = triangle_surface_point(*shape_->mesh(), chosen->triangle, b.x, b.y);
  origin.shape = uint32_t(light_->traits().shape);
  return true;
}

bool point_of_ball(const Shape& shape, const Ball& ball, const Vec3f& outward,
                   SurfacePoint& point) {
  const Ray ray{ball.center + outward * (2.0f * ball.radius), -outward};
  const auto met = shape.intersect(ray);
  if (!met) return false;
  Hit hit;
  hit.t = met->t;
  hit.u = met->u;
  hit.v = met->v;
  hit.ng = met->ng;
  point = shape.surface_point(ray, hit);
  return true;
}

}  // namespace kaustik
