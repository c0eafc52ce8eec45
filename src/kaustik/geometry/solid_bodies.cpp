#include "kaustik/geometry/solid_bodies.h"

#include "kaustik/geometry/embree_rays.h"

namespace kaustik {
namespace {

bool overlap(const Bounds3f& a, const Bounds3f& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

bool holds(const Bounds3f& box, const Vec3f& p) {
  return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y &&
         p.z >= box.min.z && p.z <= box.max.z;
}

/// Unit; along no axis or diagonal, so that it runs in no face or edge of usual bodies.
const Vec3f probing_direction(0.37139068f, 0.55708601f, 0.74278135f);

}  // namespace

SolidBodies::SolidBodies(const std::shared_ptr<EmbreeDevice>& device,
                         const std::vector<std::shared_ptr<const Shape>>& shapes,
                         std::span<const uint32_t> bodies)
    : body_of_shape_(shapes.size(), -1) {
  for (const uint32_t shape : bodies) {
    body_of_shape_[shape] = int(bodies_.size());
    Body body;
    body.shape = shape;
    body.geometry = shapes[shape].get();
    body.bounds = body.geometry->bounds();
    bodies_.push_back(std::move(body));
  }
  for (size_t i = 0; i < bodies_.size(); ++i) {
    int hidden = -1;
    for (size_t k = 0; k < bodies_.size(); ++k) {
      if (k == i || !overlap(bodies_[i].bounds, bodies_[k].bounds)) continue;
      const bool wins = k < i;
      if (!wins || hidden < 0)
        parts_.push_back({bodies_[i].shape, wins, wins ? BodyPart::nothing : bodies_[k].shape});
      if (wins && hidden < 0) hidden = int(parts_.size()) - 1;
      bodies_[i].neighbours.push_back({k, wins ? hidden : int(parts_.size()) - 1});
      Body& other = bodies_[k];
      if (!other.structure && other.geometry->mesh())
        other.structure =
            std::make_unique<const EmbreeScene>(device, EmbreeScene::Shapes{shapes[other.shape]},
                                                std::vector<EmbreeScene::Placement>());
    }
  }
}

int SolidBodies::part_at(const Vec3f& position, uint32_t shape) const {
  const int body = shape < body_of_shape_.size() ? body_of_shape_[shape] : -1;
  if (body < 0) return -1;
  for (const Neighbour& neighbour : bodies_[size_t(body)].neighbours)
    if (contains(bodies_[neighbour.body], position)) return neighbour.part;
  return -1;
}

bool SolidBodies::contains(const Body& body, const Vec3f& position) {
  if (!holds(body.bounds, position)) return false;
  const Ray ray{position, probing_direction, infinity};
  if (!body.structure) {
    const std::optional<ShapeHit> hit = body.geometry->intersect(ray);
    return hit && dot(hit->ng, ray.direction) > 0;
  }
  RTCRayHit rayhit;
  fill(rayhit.ray, ray);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  trace_closest(body.structure->get(), rayhit);
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const Vec3f ng(rayhit.hit.Ng_x, rayhit.hit.Ng_y, rayhit.hit.Ng_z);
  return dot(ng, ray.direction) > 0;
}

}  // namespace kaustik
