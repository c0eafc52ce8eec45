#include "kaustik/photon/coverage/surface_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kaustik/photon/coverage/clear_distance.h"
#include "kaustik/photon/coverage/merge_disk.h"

namespace kaustik {
namespace {

constexpr size_t direction_count = 16;
constexpr int bisections = 14;
/// Shares of the reach: height of the rays that look for walls, and of the plane how far from it
/// points of the surface may lie.
constexpr float wall_height = 0.01f, same_height = 1e-3f;
/// The same height, of those that look for what hangs low over the surface, such as a door, …
constexpr float low_height = 0.1f;
/// … and the sine of its angle to the surface from which on light ends below it as at a wall.
constexpr float upright_sine = 0.95f;
/// Cosine between normals of one plane.
constexpr float same_normal = 0.9998f;
/// A surface goes on where it rises or falls by no more than this share of the way.
constexpr float gentle = 0.3f;
/// Lines that lie so much farther than others, relative to the distance, are others.
constexpr float same_distance = 1.02f;
/// Between the two ways by which a straight end is looked for, radians.
constexpr float end_angle = 0.1f;
/// Of walls: sine of the angle between the surfaces.
constexpr float least_sine = 0.3f;

Vec3f side_of(const SurfaceVertex& vertex) { return MergeDisk(vertex, 1).side(); }

/// A line that ends the surface, and how far it lies in the direction in which it was met.
struct Candidate {
  Vec3f inward;
  float distance;  ///< from the point
  size_t direction;
  float along;
};

class EdgeSearch {
 public:
  EdgeSearch(const Scene& scene, const SurfaceVertex& vertex, float reach, uint64_t& rays)
      : disk_(vertex, reach),
        coverage_(scene, disk_, rays),
        origin_(vertex.position()),
        frame_(disk_.side()),
        reach_(reach),
        complete_(reach) {
    for (size_t i = 0; i < direction_count; ++i) look(i);
  }

  /// How far nothing was seen to end the surface but the candidates, m.
  float complete() const { return complete_; }
  Vec3f direction(size_t i) const { return across(angle_of(i)); }
  /// From near to far.
  std::vector<Candidate> candidates() {
    std::stable_sort(
        candidates_.begin(), candidates_.end(),
        [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
    return std::move(candidates_);
  }

 private:
  static float angle_of(size_t i) { return 2 * pi * float(i) / float(direction_count); }
  Vec3f across(float angle) const {
    return frame_.x * std::cos(angle) + frame_.y * std::sin(angle);
  }

  void look(size_t i) {
    const float angle = angle_of(i);
    // What lies on the surface or over it, such as a ball of glass, parts nothing.
    auto interface = coverage_.interface(wall_height * reach_, angle, reach_);
    if (interface && !stands_across(*interface)) interface.reset();
    const auto along = [&](const SurfacePoint& point) {
      return dot(point.position - origin_, across(angle));
    };
    float at_wall = interface ? along(*interface) : reach_;
    const auto wall = coverage_.obstacle(wall_height * reach_, angle, at_wall);
    if (wall) at_wall = along(*wall);
    const auto low = coverage_.obstacle(low_height * reach_, angle, at_wall / same_distance);
    if (low && ends_above(*low) && !(wall && wall->shape == low->shape)) {
      at_wall = along(*low);
      add_wall(i, *low);
    } else if (wall || interface) {
      add_wall(i, wall ? *wall : *interface);
    }
    const auto end = end_at(angle, at_wall / same_distance);
    if (!end) return;
    if (goes_on(angle, *end))
      complete_ = std::min(complete_, *end);
    else
      add_end(i, *end);
  }

  /// How far the plane goes on, if not as far as `farthest`.
  std::optional<float> end_at(float angle, float farthest) const {
    for (const float share : {0.25f, 0.5f, 0.75f, 1.0f}) {
      const float distance = share * farthest;
      if (is_same_plane(angle, distance)) continue;
      float near = distance - 0.25f * farthest, far = distance;
      for (int step = 0; step < bisections; ++step) {
        const float middle = 0.5f * (near + far);
        (is_same_plane(angle, middle) ? near : far) = middle;
      }
      return near;
    }
    return std::nullopt;
  }
  /// Under what hangs over the surface, as light that merges there is.
  std::optional<SurfacePoint> surface_at(float distance, float angle) const {
    return coverage_.surface_at(wall_height * reach_, disk_.flatness(), distance, angle);
  }
  bool is_same_plane(float angle, float distance) const {
    const auto surface = surface_at(distance, angle);
    return surface && coverage_.merges_at(*surface) &&
           std::fabs(dot(surface->ng, frame_.z)) > same_normal &&
           std::fabs(dot(surface->position - origin_, frame_.z)) <= same_height * reach_;
  }
  /// Whether there is, a little beyond, what the surface may have turned to by and by.
  bool goes_on(float angle, float distance) const {
    const float step = 0.05f * reach_;
    const auto surface = surface_at(distance + step, angle);
    return surface && coverage_.merges_at(*surface) &&
           std::fabs(dot(surface->position - origin_, frame_.z)) <= gentle * step;
  }

  Vec3f in_plane_of(const Vec3f& normal) const { return normal - frame_.z * dot(normal, frame_.z); }
  bool stands_across(const SurfacePoint& wall) const {
    return length(in_plane_of(wall.ng)) >= least_sine;
  }
  /// Whether light below it ends at the line where it would meet the surface.
  bool ends_above(const SurfacePoint& low) const {
    return length(in_plane_of(low.ng)) >= upright_sine && !coverage_.merges_at(low);
  }
  void add_wall(size_t i, const SurfacePoint& wall) {
    const Vec3f in_plane = in_plane_of(wall.ng);
    const float sine = length(in_plane);
    if (sine < least_sine || coverage_.merges_at(wall)) {
      complete_ = std::min(complete_, length(wall.position - origin_));
      return;
    }
    const float distance = dot(wall.ng, origin_ - wall.position) / sine;
    add(i, in_plane * ((distance < 0 ? -1 : 1) / sine), std::fabs(distance));
  }
  /// A line through that end and another one beside it; straight across if there is none.
  void add_end(size_t i, float distance) {
    const Vec3f end = direction(i) * distance;
    for (const float angle : {angle_of(i) + end_angle, angle_of(i) - end_angle}) {
      const auto other = end_at(angle, reach_);
      if (!other) continue;
      const Vec3f in_plane = cross(across(angle) * *other - end, frame_.z);
      const float size = length(in_plane);
      const float offset = dot(end, in_plane) / size;
      if (!(std::fabs(offset) > least_sine * distance)) continue;
      add(i, in_plane * ((offset > 0 ? -1 : 1) / size), std::fabs(offset));
      return;
    }
    add(i, direction(i) * -1.0f, distance);
  }
  void add(size_t i, const Vec3f& inward, float distance) {
    const float cosine = -dot(inward, direction(i));
    if (!(cosine > 0)) {
      complete_ = std::min(complete_, distance);
      return;
    }
    candidates_.push_back({inward, distance, i, distance / cosine});
  }

  MergeDisk disk_;
  DiskCoverage coverage_;
  Vec3f origin_;
  Frame frame_;
  float reach_;
  std::vector<Candidate> candidates_;
  float complete_;
};

}  // namespace

SurfaceEdges::SurfaceEdges(const Scene& scene, const SurfaceVertex& vertex, float reach,
                           uint64_t& rays)
    : position_(vertex.position()), normal_(side_of(vertex)), reach_(reach) {
  find_lines(scene, vertex, rays);
  // Rays over the surface start no higher than that (DiskCoverage).
  clear_ =
      clear_distance(scene, {position_, normal_, same_height * reach, DiskCoverage::highest(reach)},
                     around(position_, infinity), reach);
}

void SurfaceEdges::find_lines(const Scene& scene, const SurfaceVertex& vertex, uint64_t& rays) {
  EdgeSearch search(scene, vertex, reach_, rays);
  for (const Candidate& candidate : search.candidates()) {
    float known = infinity;
    for (const Line& line : lines_) {
      const float cosine = -dot(line.inward, search.direction(candidate.direction));
      if (cosine > 0) known = std::min(known, line.distance / cosine);
    }
    if (candidate.along * same_distance >= known) continue;
    if (lines_.size() == DiskEdges::most) {
      complete_ = std::min(search.complete(), candidate.distance);
      return;
    }
    lines_.push_back({candidate.inward, candidate.distance});
  }
  complete_ = search.complete();
}

bool SurfaceEdges::hold_at(const SurfaceVertex& vertex) const {
  const Vec3f across = vertex.position() - position_;
  if (!(dot(side_of(vertex), normal_) > same_normal) ||
      std::fabs(dot(across, normal_)) > same_height * reach_)
    return false;
  for (const Line& line : lines_)
    if (dot(line.inward, across) < -line.distance) return false;
  return true;
}

ClearDisk SurfaceEdges::clear_disk(const Vec3f& position) const {
  const float radius = std::max(0.0f, clear_ - length(position - position_));
  return {normal_, radius, flatness(), around(position, radius)};
}

float SurfaceEdges::flatness() const { return 2 * same_height * reach_; }

DiskEdges SurfaceEdges::around(const Vec3f& position, float radius) const {
  DiskEdges result;
  for (const Line& line : lines_) {
    const float distance = line.distance + dot(line.inward, position - position_);
    if (distance < radius) result.edges[result.count++] = {line.inward, std::max(0.0f, distance)};
  }
  return result;
}

}  // namespace kaustik
