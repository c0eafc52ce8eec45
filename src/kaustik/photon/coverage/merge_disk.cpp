#include "kaustik/photon/coverage/merge_disk.h"

#include "kaustik/photon/coverage/covered_share.h"
#include "kaustik/photon/coverage/look_through.h"

namespace kaustik {
namespace {

/// Share of the radius from which disks are looked at: over the surface by so much that a curved
/// one does not count as in its own way.
constexpr float height_share = 0.25f;
/// Of the radius: what hangs no higher than that makes disks smaller.
constexpr float per_clearance = 2;
/// Of the radius: what lies so close over a light vertex is its own surface.
constexpr float own_surface = 1e-3f;
/// Disks are hardly ever covered by less than one over this.
constexpr int most_tries = 32;
/// Points that are tried at most: slivers are left of hardly any disk.
constexpr int most_points = 256;

}  // namespace

template <typename Stops>
float DiskCoverage::distance_to(const Ray& ray, const Stops& stops) const {
  float passed = 0;
  const Look look =
      look_through(scene_, ray, rays_, [&](const SurfacePoint& point, const Hit& hit) {
        passed += hit.t;
        return stops(point);
      });
  // So many layers that it is not followed through them hide what lies behind.
  return look == Look::free ? float(infinity) : passed;
}

DiskCoverage::DiskCoverage(const Scene& scene, const MergeDisk& widest, uint64_t& rays,
                           float clear_flatness)
    : scene_(scene),
      vertex_(widest.vertex()),
      frame_(widest.side()),
      both_sides_(widest.both_sides()),
      rays_(rays),
      clear_flatness_(clear_flatness) {
  if (clear_flatness > 0) return;
  // From off the surface, by what its position may be wrong.
  Ray up = spawn_ray(vertex_.point(), frame_.z);
  const float least = std::max(dot(up.origin - vertex_.position(), frame_.z), 0.0f);
  up.t_max = widest.radius() / per_clearance - least;
  free_ = least + distance_to(up, [&](const SurfacePoint& point) { return hides(point); });
}

float DiskCoverage::highest(float radius) {
  return std::max(height_share, 1 / per_clearance) * radius;
}

float DiskCoverage::clear_radius() const { return per_clearance * free_; }

bool DiskCoverage::merges_at(const SurfacePoint& point) const {
  const bool keeps_light = scene_.film().quantity == Quantity::irradiance ||
                           any(scene_.surface(point.shape).traits.lobes & MergeDisk::keeping());
  const float cosine = dot(point.ng, vertex_.point().ng);
  return keeps_light && (both_sides_ ? cosine : std::fabs(cosine)) > MergeDisk::least_cosine();
}

bool DiskCoverage::hides(const SurfacePoint& point) const {
  return kaustik::hides(scene_, point.shape, vertex_.point().shape);
}

template <typename Stops>
std::optional<SurfacePoint> DiskCoverage::first_on_way(float height, const Vec3f& direction,
                                                       float reach, const Stops& stops) const {
  std::optional<SurfacePoint> result;
  distance_to({vertex_.position() + frame_.z * free_height(height), direction, reach},
              [&](const SurfacePoint& point) {
                if (stops(point)) result = point;
                return result.has_value();
              });
  return result;
}

std::optional<SurfacePoint> DiskCoverage::obstacle(float height, float angle, float reach) const {
  return first_on_way(height, across(angle), reach,
                      [&](const SurfacePoint& point) { return hides(point); });
}

std::optional<SurfacePoint> DiskCoverage::interface(float height, float angle, float reach) const {
  return first_on_way(height, across(angle), reach, [&](const SurfacePoint& point) {
    const Surface& surface = scene_.surface(point.shape);
    return surface.traits.transmits && surface.traits.lobes == Lobes::delta;
  });
}

std::optional<SurfacePoint> DiskCoverage::surface_at(float wanted_height, float depth,
                                                     float distance, float angle) const {
  const float height = free_height(wanted_height);
  const Vec3f over = vertex_.position() + frame_.z * height + across(angle) * distance;
  std::optional<SurfacePoint> result;
  distance_to({over, -frame_.z, height + depth}, [&](const SurfacePoint& point) {
    if (merges_at(point) || hides(point)) result = point;
    return result.has_value();
  });
  return result;
}

bool DiskCoverage::is_way_free(float height, const Vec3f& direction, float distance) const {
  if (clear_flatness_ > 0 || !(distance > 0)) return true;
  // Most often there is nothing at all, which is told sooner than what is nearest.
  ++rays_;
  if (!scene_.occluded({vertex_.position() + frame_.z * free_height(height), direction, distance}))
    return true;
  return !first_on_way(height, direction, distance,
                       [&](const SurfacePoint& point) { return hides(point); });
}

std::optional<SurfacePoint> DiskCoverage::merging_at(float radius, float distance,
                                                     float angle) const {
  const float height = height_share * radius;
  const MergeDisk disk(vertex_, radius, clear_flatness_ > 0 ? clear_flatness_ : float(infinity));
  const auto surface = surface_at(height, disk.flatness(), distance, angle);
  if (!surface || !merges_at(*surface) || !is_way_free(height, across(angle), distance)) return {};
  return surface;
}

float DiskCoverage::held(float radius, float distance, float angle) const {
  const auto surface = merging_at(radius, distance, angle);
  if (!surface) return 0;
  const float rise_sq = sqr(dot(surface->position - vertex_.position(), frame_.z));
  const float left_sq = sqr(radius) - sqr(distance);
  return left_sq > rise_sq ? 1 - rise_sq / left_sq : 0.0f;
}

bool DiskCoverage::reaches(float radius, const Vec3f& offset) const {
  if (clear_flatness_ > 0) return true;
  const float height = height_share * radius;
  const float rise = dot(offset, frame_.z);
  const Vec3f along = offset - frame_.z * rise;
  const float distance = length(along);
  if (!is_way_free(height, distance > 0 ? along * (1 / distance) : frame_.x, distance))
    return false;
  // Its own surface is not in the way.
  const float over = free_height(height);
  const float down = over - rise;
  const Ray ray{vertex_.position() + along + frame_.z * over, frame_.z * (down < 0 ? 1.0f : -1.0f),
                std::fabs(down) - own_surface * radius};
  ++rays_;
  return !scene_.occluded(ray) || distance_to(ray, [&](const SurfacePoint& point) {
                                    return merges_at(point) || hides(point);
                                  }) == infinity;
}

float DiskCoverage::inverse_share(float radius, const DiskEdges& edges, Sampler numbers) const {
  return float(tries_until_held(most_tries, most_points, [&] {
    // A point of the disk, with the density of the kernel.
    const Vec2f u = numbers.next_2d();
    const float distance = radius * std::sqrt(1 - std::sqrt(1 - u.x)), angle = 2 * pi * u.y;
    if (!edges.hold(across(angle) * distance)) return CoveredPoint::outside;
    const float share = held(radius, distance, angle);
    const bool counts = share > 0 && (share == 1 || numbers.next_1d() < share);
    return counts ? CoveredPoint::held : CoveredPoint::covered;
  }));
}

}  // namespace kaustik
