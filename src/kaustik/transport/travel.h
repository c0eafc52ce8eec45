#pragma once
#include <utility>

#include "kaustik/transport/null_boundaries.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

// The steps that paths of all kinds take, from whichever end they began.

/// Straight on through a null boundary. A camera's ray may end: it has so much less to go.
inline void pass_boundary(const SurfaceVertex& boundary, PathState& state, Ray& ray) {
  const float rest = ray.t_max - length(boundary.position() - ray.origin);
  state.medium = boundary.medium_toward(ray.direction, state.medium);
  ray = spawn_ray(boundary.point(), ray.direction);
  ray.t_max = rest;
}

/// On from `vertex` by an event that was sampled with that density. What it leaves of the
/// throughput is the caller's affair.
inline void leave(const SurfaceVertex& vertex, const BsdfSample& sample, float pdf_solid_angle,
                  PathState& state, Ray& ray) {
  state.footprint.scatter(sample.event, pdf_solid_angle);
  state.depth += 1;
  state.follow_lanes_of(sample);
  state.medium = vertex.medium_toward(sample.wi, state.medium);
  ray = spawn_ray(vertex.point(), sample.wi);
}

/// Follows a path along `ray`, segment by segment, to the next surface that is more than a boundary
/// of media: `vertex`. `go_on(hit, found)` is told of every segment, which runs through
/// `state.medium` to hit.t and meets a surface there if one was found; where it answers false the
/// path ends on the way. False if it has. Counts rays. (Light paths advance side by side, one
/// segment each: trace_light_paths.)
template <typename GoOn>
bool travel(const Scene& scene, PathState& state, Ray& ray, SurfaceVertex& vertex, uint64_t& rays,
            const GoOn& go_on) {
  for (int boundary = 0;; ++boundary) {
    Hit hit;
    ++rays;
    const bool found = scene.intersect(ray, hit);
    if (!go_on(std::as_const(hit), found) || !found) return false;
    state.footprint.travel(hit.t);
    vertex.meet(scene, ray, hit, state);
    if (!vertex.is_null()) return true;
    if (boundary == most_null_boundaries) return false;
    pass_boundary(vertex, state, ray);
  }
}

}  // namespace kaustik
