#pragma once
#include "kaustik/base/sampler.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/path_state.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// A light path's meeting with a surface, as handlers see it.
struct LightVertex {
  SurfaceVertex vertex;       ///< mode flux; wo points back along the path
  PathState state;            ///< throughput: flux that arrives, W, before any attenuation here
  LightPathClass path_class;  ///< the events before this vertex
  float distance = 0;         ///< from the path's previous vertex, m
};

/// Events after which no light path goes on for certain.
inline constexpr int certain_events = 16;

struct LightPathLimits {
  int maximum_events = 1 << 20;    ///< scattering events
  Lobes traced = Lobes::specular;  ///< lobes whose events count as specular
};

/// What became of a light path, for the counts of a light pass.
enum class LightPathEnd { escaped, absorbed, too_long, stopped };

struct LightPathResult {
  LightPathEnd end = LightPathEnd::escaped;
  uint32_t rays = 0;
};

/// Follows a light path from its emitted ray with flux `flux` (W). At every surface
/// `handler(const LightVertex&)` answers with the lobes by which the path may go on (Lobes::none
/// stops it). Russian roulette survives with the largest lane of the event's weight, so the flux of
/// the survivors stays even; shared by global, caustic and splatted light [Schregle 1998].
template <typename Handler>
LightPathResult trace_light_path(const Scene& scene, const Ray& emitted, const Spectrum& flux,
                                 Sampler& sampler, const LightPathLimits& limits,
                                 const Handler& handler) {
  LightPathResult result;
  LightVertex at;
  at.state.mode = TransportMode::flux;
  at.state.throughput = flux;
  at.path_class = LightPathClass(limits.traced);
  Ray ray = emitted;
  for (;;) {
    Hit hit;
    ++result.rays;
    if (!scene.intersect(ray, hit)) {
      result.end = LightPathEnd::escaped;
      return result;
    }
    at.vertex.meet(scene, ray, hit, TransportMode::flux);
    at.distance = hit.t;
    const Lobes follow = handler(static_cast<const LightVertex&>(at));
    if (!any(follow)) {
      result.end = LightPathEnd::stopped;
      return result;
    }
    if (at.path_class.events() >= limits.maximum_events) {
      result.end = LightPathEnd::too_long;
      return result;
    }
    sampler.start_vertex(uint32_t(at.path_class.events()));
    const Vec2f u = sampler.next_2d();
    const Vec2f u_choice = sampler.next_2d();
    const BsdfSample sample = at.vertex.sample(u_choice.x, u, follow);
    // Light that total reflection or perfect mirrors trap would never end.
    const float limit = at.path_class.events() < certain_events ? 1.0f : 0.95f;
    const float survival = std::min(limit, sample.weight.max_lane());
    if (sample.event == Lobes::none || !(u_choice.y < survival)) {
      result.end = LightPathEnd::absorbed;
      return result;
    }
    at.state.throughput *= sample.weight * (1 / survival);
    at.state.pdf_forward = sample.event == Lobes::delta ? 0 : sample.pdf_solid_angle;
    at.state.depth += 1;
    at.path_class.add_event(sample.event);
    ray = spawn_ray(at.vertex.point(), sample.wi);
  }
}

}  // namespace kaustik
