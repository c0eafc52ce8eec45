#include "kaustik/integrator/merge_disk.h"

namespace kaustik {
namespace {

/// Share of the radius from which disks are looked at: over the surface by so much that a curved
/// one does not count as in its own way.
constexpr float height_share = 0.25f;
/// Disks are hardly ever covered by less than one over this.
constexpr int most_tries = 32;
/// That light passes through, one over the other.
constexpr int most_layers = 4;

}  // namespace

template <typename Stops>
float DiskCoverage::distance_to(Ray ray, const Stops& stops) const {
  float passed = 0;
  for (int layer = 0; layer < most_layers && ray.t_max > 0; ++layer) {
    Hit hit;
    ++rays_;
    if (!scene_.intersect(ray, hit)) break;
    const SurfacePoint point = scene_.tracer().surface_point(ray, hit);
    passed += hit.t;
    if (stops(point)) return passed;
    ray.t_max -= hit.t;
    ray.origin = spawn_ray(point, ray.direction).origin;
  }
  return infinity;
}

DiskCoverage::DiskCoverage(const Scene& scene, const MergeDisk& widest, uint64_t& rays)
    : scene_(scene),
      vertex_(widest.vertex()),
      frame_(widest.side()),
      both_sides_(widest.both_sides()),
      rays_(rays) {
  const float least = 1e-3f * widest.radius();
  const Ray up{vertex_.position() + frame_.z * least, frame_.z,
               height_share * widest.radius() - least};
  free_ = least + distance_to(up, [&](const SurfacePoint& point) { return hides(point); });
}

bool DiskCoverage::merges_at(const SurfacePoint& point) const {
  const bool keeps_light =
      scene_.film().quantity == Quantity::irradiance ||
      any(scene_.surface(point.shape).bsdf->lobes() & (Lobes::diffuse | Lobes::glossy));
  const float cosine = dot(point.ng, vertex_.point().ng);
  return keeps_light && (both_sides_ ? cosine : std::fabs(cosine)) > MergeDisk::least_cosine();
}

bool DiskCoverage::hides(const SurfacePoint& point) const {
  return point.shape == vertex_.point().shape || !scene_.surface(point.shape).bsdf->transmits();
}

bool DiskCoverage::holds(float radius, float distance, float angle) const {
  const float wanted = height_share * radius;
  const float height = wanted < free_ ? wanted : 0.5f * free_;
  const Vec3f above = vertex_.position() + frame_.z * height;
  const Vec3f over =
      above + frame_.x * (distance * std::cos(angle)) + frame_.y * (distance * std::sin(angle));
  bool merges = false;
  distance_to({over, -frame_.z, height + MergeDisk(vertex_, radius).flatness()},
              [&](const SurfacePoint& point) {
                merges = merges_at(point);
                return merges || hides(point);
              });
  if (!merges) return false;
  const Vec3f across = over - above;
  const float distance_there = length(across);
  return !(distance_there > 0) ||
         std::isinf(distance_to({above, across * (1 / distance_there), distance_there},
                                [&](const SurfacePoint& point) { return hides(point); }));
}

float DiskCoverage::inverse_share(float radius, Sampler numbers) const {
  for (int tries = 1; tries < most_tries; ++tries) {
    // A point of the disk, with the density of the kernel.
    const Vec2f u = numbers.next_2d();
    if (holds(radius, radius * std::sqrt(1 - std::sqrt(1 - u.x)), 2 * pi * u.y))
      return float(tries);
  }
  return float(most_tries);
}

}  // namespace kaustik
