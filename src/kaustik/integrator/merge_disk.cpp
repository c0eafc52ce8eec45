#include "kaustik/integrator/merge_disk.h"

namespace kaustik {

bool MergeDisk::is_covered(float distance, float angle, uint64_t& rays) const {
  // Over the surface by so much that a curved one does not count as in its own way.
  const Vec3f& normal = frame_.z;
  const Vec3f above = center_ + normal * height_;
  const Vec3f over =
      above + frame_.x * (distance * std::cos(angle)) + frame_.y * (distance * std::sin(angle));
  Hit hit;
  const Ray down{over, -normal, height_ + flatness()};
  if (!meets(down, hit, rays)) return false;
  if (!(dot(scene_.tracer().surface_point(down, hit).ng, ng_) > least_cosine_)) return false;
  const Vec3f across = over - above;
  const float distance_there = length(across);
  if (!(distance_there > 0)) return true;
  return !meets({above, across * (1 / distance_there), distance_there}, hit, rays);
}

bool MergeDisk::look_from_below(uint64_t& rays) {
  Hit hit;
  const float least = 1e-3f * radius_;
  const Ray up{center_ + frame_.z * least, frame_.z, height_ - least};
  if (!meets(up, hit, rays)) return false;
  height_ = 0.5f * (least + hit.t);
  return true;
}

/// What light passes through hides nothing, but for the surface itself.
bool MergeDisk::meets(Ray ray, Hit& hit, uint64_t& rays) const {
  constexpr int most_layers = 4;
  for (int layer = 0; layer < most_layers; ++layer) {
    ++rays;
    if (!scene_.intersect(ray, hit)) return false;
    const SurfacePoint point = scene_.tracer().surface_point(ray, hit);
    if (point.shape == shape_ || !scene_.surface(point.shape).bsdf->transmits()) return true;
    ray.t_max -= hit.t;
    ray.origin = spawn_ray(point, ray.direction).origin;
    if (!(ray.t_max > 0)) return false;
  }
  return false;
}

}  // namespace kaustik
