#include "kaustik/integrator/covered_disk.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kaustik {
namespace {

/// Shares of the radius: height over the vertex from which its disk is looked at, how close to its
/// plane a surface is the same one, and how high over the plane ways along it lie.
constexpr float height_share = 0.5f, flat_share = 0.02f, low_share = 0.02f;
/// Cosine between the vertex's normal and those of surfaces whose photons count.
constexpr float least_cosine = 0.05f;
/// Disks are hardly ever covered by less than a few times one over this.
constexpr int most_tries = 64;
/// Of glass and the like that is looked through.
constexpr int most_layers = 16;

/// Asks of points of the disk whether photons that lie there would count, and how much.
class Disk {
 public:
  Disk(const PhotonSurroundings& around, const EstimateSettings& kernel, float radius,
       uint64_t& rays)
      : around_(around),
        kernel_(kernel),
        radius_(radius),
        rays_(rays),
        frame_(around.vertex.on_front() ? around.vertex.point().ng : -around.vertex.point().ng),
        center_(around.vertex.position()),
        off_(spawn_ray(around.vertex.point(), frame_.z).origin),
        sight_(around.scene, center_, around.vertex.point().shape, rays) {}

  /// What counts at the point of the plane that far away in that direction, relative to what would
  /// if it were of the surface.
  float share(float distance, float angle) const {
    const Vec3f across =
        frame_.x * (distance * std::cos(angle)) + frame_.y * (distance * std::sin(angle));
    // Most often the disk is flat and whole, which one ray tells.
    const Vec3f over = off_ + frame_.z * (height_share * radius_);
    const Vec3f to = center_ + across - over;
    const auto seen = photons_at({over, to, 1 + flat_share / height_share});
    if (seen && std::fabs(dot(*seen - center_, frame_.z)) <= flat_share * radius_) return 1;
    return share_below(across, distance);
  }

 private:
  /// By ways along the plane, or from over it where the surface rises.
  float share_below(const Vec3f& across, float distance) const {
    const Vec3f low = center_ + across + frame_.z * (low_share * radius_);
    const bool is_low = sight_.is_free({off_, low - off_, 1});
    const Vec3f from = is_low ? low : center_ + across + frame_.z * (height_share * radius_);
    const float height = (is_low ? low_share : height_share) * radius_;
    const auto seen = photons_at({from, -frame_.z, height + radius_});
    if (!seen) return 0;
    const float away = length(*seen - center_);
    if (!(away < radius_) || !sight_.sees(frame_.z, *seen, frame_.z)) return 0;
    return std::min(1.0f, kernel_falloff(kernel_, away / radius_) /
                              kernel_falloff(kernel_, distance / radius_));
  }
  /// Where the ray meets the first surface, but for those that light passes through, if that keeps
  /// photons on the side of the vertex.
  std::optional<Vec3f> photons_at(Ray ray) const {
    for (int layer = 0; layer < most_layers && ray.t_max > 0; ++layer) {
      Hit hit;
      ++rays_;
      if (!around_.scene.intersect(ray, hit)) return {};
      const SurfacePoint point = around_.scene.tracer().surface_point(ray, hit);
      const Surface& surface = around_.scene.surface(hit.shape);
      if (any(surface.lobes & around_.keeping)) {
        const float cosine = dot(point.ng, frame_.z);
        if ((dot(point.ng, ray.direction) < 0 ? cosine : -cosine) > least_cosine)
          return point.position;
        return {};
      }
      if (!surface.transmits) return {};
      ray.t_max -= hit.t;
      ray.origin = offset_origin(point, ray.direction);
    }
    return {};
  }

  const PhotonSurroundings& around_;
  const EstimateSettings& kernel_;
  const float radius_;
  uint64_t& rays_;
  const Frame frame_;  ///< z: the side that is seen
  const Vec3f center_;
  const Vec3f off_;  ///< the center, off the surface
  const SurfaceSight sight_;
};

}  // namespace

float inverse_covered_share(const PhotonSurroundings& around, const EstimateSettings& kernel,
                            float radius, Sampler numbers, uint64_t& rays) {
  const Disk disk(around, kernel, radius, rays);
  int tries = 1;
  for (; tries < most_tries; ++tries) {
    const Vec2f u = numbers.next_2d();
    const float distance = radius * kernel_distance(kernel, u.x);
    const float share = disk.share(distance, 2 * pi * u.y);
    if (share == 1 || (share > 0 && numbers.next_1d() < share)) break;
  }
  return float(tries);
}

}  // namespace kaustik
