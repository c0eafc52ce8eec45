#pragma once
#include <algorithm>
#include <utility>

#include "kaustik/base/sampler.h"
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

/// What becomes of a path at a surface where light may go straight on.
enum class Passing {
  by_chance,  ///< it does so as often as that is worth
  always,     ///< the surface is looked through
  never
};

/// With which a path goes straight on at `vertex`, 0 to 1: the share of `straight` in the light
/// that does not end there. Lamps are looked at half of the time at least.
inline float passing_chance(const SurfaceVertex& vertex, const Spectrum& straight) {
  const float through = straight.max_lane();
  if (!(through > 0)) return 0;
  float here = vertex.albedo(Lobes::all).max_lane();
  if (vertex.light() >= 0) here = std::max(here, through);
  return through / (through + here);
}

/// Whether the path goes straight on at `vertex`; its throughput makes up for the choice. Densities
/// of events don't know of it: what they weigh is the same for all ways to find a path.
inline bool passes_by_chance(const SurfaceVertex& vertex, Spectrum& throughput, Sampler& sampler) {
  if (!vertex.passes_straight()) return false;
  const Spectrum straight = vertex.straight();
  const float chance = passing_chance(vertex, straight);
  if (chance == 0) return false;
  const bool passes = chance == 1 || sampler.next_1d() < chance;
  throughput *= passes ? straight * (1 / chance) : Spectrum(1 / (1 - chance));
  return passes;
}

/// Follows a path along `ray`, segment by segment, to the next surface that is more than a boundary
/// of media and that it does not pass: `vertex`. `go_on(hit, found)` is told of every segment,
/// which runs through `state.medium` to hit.t and meets a surface there if one was found; where it
/// answers false the path ends on the way. False if it has. `passing(vertex)` tells how surfaces
/// are passed. Counts rays. (Light paths advance side by side, one segment each:
/// trace_light_paths.)
template <typename GoOn, typename HowToPass>
bool travel(const Scene& scene, PathState& state, Ray& ray, SurfaceVertex& vertex, uint64_t& rays,
            Sampler& sampler, const GoOn& go_on, const HowToPass& passing) {
  for (int boundary = 0;; ++boundary) {
    Hit hit;
    ++rays;
    const bool found = scene.intersect(ray, hit);
    if (!go_on(std::as_const(hit), found) || !found) return false;
    state.footprint.travel(hit.t);
    vertex.meet(scene, ray, hit, state);
    if (!vertex.is_null()) {
      const Passing how = passing(std::as_const(vertex));
      const bool passes =
          how == Passing::always ||
          (how == Passing::by_chance && passes_by_chance(vertex, state.throughput, sampler));
      if (!passes) return true;
    }
    if (boundary == most_null_boundaries) return false;
    pass_boundary(vertex, state, ray);
  }
}

/// The same, surfaces being passed by chance.
template <typename GoOn>
bool travel(const Scene& scene, PathState& state, Ray& ray, SurfaceVertex& vertex, uint64_t& rays,
            Sampler& sampler, const GoOn& go_on) {
  return travel(scene, state, ray, vertex, rays, sampler, go_on,
                [](const SurfaceVertex&) { return Passing::by_chance; });
}

}  // namespace kaustik
