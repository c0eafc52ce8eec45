#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/transport/gauge_disks.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/path_state.h"
#include "kaustik/transport/roulette.h"
#include "kaustik/transport/scatter_guide.h"
#include "kaustik/transport/travel.h"

namespace kaustik {

/// A path that is followed from a light, between two surfaces.
struct LightPath {
  /// `medium`: that the light shines into. `wavelengths`: of the flux.
  LightPath(const Ray& emitted, const Spectrum& flux, const Medium* medium, Lobes traced,
            const Sampler& its_sampler, const Wavelengths& wavelengths)
      : ray(emitted), path_class(traced), sampler(its_sampler) {
    state.wavelengths = wavelengths;
    state.mode = TransportMode::flux;
    state.throughput = flux;
    state.medium = medium;
  }

  void attenuate(const Spectrum& factor) {
    state.throughput *= factor;
    weight *= factor;
  }

  Ray ray;             ///< along which it goes on
  uint32_t index = 0;  ///< its number, as trace_light_paths() was asked for it
  PathState state;     ///< throughput: flux that arrives, W, before any attenuation there
  LightPathClass path_class;
  Sampler sampler;
  Spectrum weight{1.0f};  ///< the throughput's share of what was emitted, but for what guiding and
                          ///< length_survival() make of it; roulette keeps it about 1
  int boundaries = 0;     ///< passed since the last event
  uint32_t segments = 0;  ///< traced so far: those across null boundaries count, each has a block
                          ///< of random numbers
  float distance = 0;     ///< from the last event to the origin of `ray`, m
};

/// A light path's meeting with a surface, as handlers see it.
struct LightVertex {
  const SurfaceVertex& vertex;  ///< mode flux; wo points back along the path
  const PathState& state;
  const LightPathClass& path_class;  ///< the events before this vertex
  float distance;                    ///< from the path's previous vertex, m
  uint32_t path;                     ///< number of the path
  const Ray& ray;                    ///< that met the surface …
  const Hit& hit;                    ///< … and where
  const Sampler& sampler;            ///< of the path; to be forked
};

/// A point of a segment through a medium, drawn as if light were sure to be scattered there: one
/// for every segment through a medium that scatters, whether the path goes on from there or not.
struct LightMediumVertex {
  Vec3f position;
  Vec3f wo;  ///< unit, back along the path
  const Medium& medium;
  Spectrum flux;                     ///< that the medium scatters within the segment, W
  const LightPathClass& path_class;  ///< the events before this vertex
  float distance;                    ///< from the path's previous vertex, m
  const PathState& state;            ///< at the begin of the segment
  uint32_t path;                     ///< number of the path
  const Sampler& sampler;            ///< of the path; to be forked
};

/// The point of the segment where free flight has ended, from which the path goes on unless it is
/// absorbed there. The mean flux over such points is that of the points above.
struct LightMediumEvent {
  LightMediumVertex at;
};

/// Where light passes a gauge's disk. The path goes on as if there were none.
struct LightAtGauge {
  const GaugeDisks::Crossing& crossing;
  Vec3f wo;                          ///< unit, back along the path
  Spectrum flux;                     ///< W
  const LightPathClass& path_class;  ///< the events before
  float distance;                    ///< from the path's previous vertex, m
  const PathState& state;            ///< at the begin of the segment
  uint32_t path;                     ///< number of the path
};

/// Where light paths may go on after they are scattered in a medium.
enum class MediumEvents {
  follow,        ///< everywhere
  after_events,  ///< where there was an event before
  stop           ///< nowhere
};

struct LightPathLimits {
  int maximum_events = any_number_of_events;  ///< scattering events
  Lobes traced = Lobes::specular;             ///< lobes whose events count as specular
  MediumEvents in_media = MediumEvents::follow;
  /// Where bent normals are met at grazing incidence, flux grows without bound, rarely (the factor
  /// of SurfaceVertex::eval_cosine): what is beyond this share of the emitted flux is cut off. What
  /// roulette gives to those that survive is not cut.
  float largest_weight = infinity;
  bool needs_reverse_pdf = false;  ///< PathState::pdf_reverse is to be found out
  /// Where paths that may go on by all lobes do so; null: by the bsdf alone.
  const ScatterGuide* guide = nullptr;
  /// Whose disks a handler that takes LightAtGauge is shown; null: none.
  const GaugeDisks* gauges = nullptr;
};

/// What became of light paths.
struct LightPathCounts {
  uint64_t rays = 0;
  uint64_t escaped = 0, absorbed = 0, too_long = 0;
  uint64_t absorbed_in_media = 0;
  uint64_t stopped = 0;  ///< by the handler, in a medium by LightPathLimits::in_media, or at
                         ///< most_null_boundaries
};

/// Scatters `path` at `vertex`, by the lobes `follow`: true if it goes on. Russian roulette
/// survives with the largest lane of the path's weight, so the flux of the survivors stays even,
/// and by length_survival(); shared by global, caustic and splatted light [Schregle 1998].
bool scatter_light_path(const SurfaceVertex& vertex, Lobes follow, const LightPathLimits& limits,
                        LightPath& path);

/// passes_by_chance() of a light path.
inline bool passes_straight(const SurfaceVertex& vertex, LightPath& path) {
  if (!vertex.passes_straight()) return false;
  Spectrum factor(1);
  const bool passes = passes_by_chance(vertex, factor, path.sampler);
  path.attenuate(factor);
  return passes;
}

/// The point of its segment through its medium where `path` is scattered by `flight`.
LightMediumVertex medium_vertex(const LightPath& path, const Medium::Flight& flight);
/// The point of its segment through its medium, of length `limit`, where `path` is scattered
/// surely; the flux is zero where nothing scatters.
LightMediumVertex sample_medium_vertex(LightPath& path, float limit);

/// Free flight of `path` along its segment of length `limit`.
inline Medium::Flight fly_through_medium(LightPath& path, float limit) {
  return path.state.medium->sample_flight({path.ray.origin, path.ray.direction, limit},
                                          path.state.throughput, path.state.wavelengths,
                                          path.sampler);
}
/// What becomes of a path that a medium takes out of its flight.
enum class MediumFate { scattered, absorbed, stopped, too_long };
/// Scatters `path` where `flight` has ended: it has a new ray then.
MediumFate scatter_in_medium(LightPath& path, const Medium::Flight& flight,
                             const LightPathLimits& limits);

/// Calls `handler(LightAtGauge)` for the disks that the path's segment of length `limit` passes.
template <typename Handler>
void show_at_gauges(const LightPath& path, float limit, const GaugeDisks& gauges,
                    const Handler& handler) {
  gauges.visit_crossed(path.ray, limit, [&](const GaugeDisks::Crossing& crossing) {
    Spectrum flux = path.state.throughput;
    if (path.state.medium)
      flux *=
          path.state.medium->transmittance({path.ray.origin, path.ray.direction, crossing.distance},
                                           path.state.wavelengths, path.sampler);
    handler(LightAtGauge{.crossing = crossing,
                         .wo = -path.ray.direction,
                         .flux = flux,
                         .path_class = path.path_class,
                         .distance = path.distance + crossing.distance,
                         .state = path.state,
                         .path = path.index});
  });
}

/// Handlers of different vertices as one.
template <typename... Parts>
struct Handlers : Parts... {
  using Parts::operator()...;
};
template <typename... Parts>
Handlers(Parts...) -> Handlers<Parts...>;

/// Follows the light paths `begin` to `end`. `emit(i)` gives the i-th, or nothing. At every surface
/// `handler(const LightVertex&)` answers with the lobes by which the path may go on (Lobes::none
/// stops it). A handler that also takes a LightMediumVertex, a LightMediumEvent or a LightAtGauge
/// is shown those. Some dozens of paths advance side by side: their rays are traced in packets, and
/// the memory that they need is fetched early (`make bench` compares with rays one by one). The
/// order is the same in every run.
template <typename Emit, typename Handler>
LightPathCounts trace_light_paths(const Scene& scene, uint32_t begin, uint32_t end,
                                  const LightPathLimits& limits, const Emit& emit,
                                  const Handler& handler) {
  constexpr uint32_t group = 32;
  LightPathCounts counts;
  std::vector<LightPath> paths;
  paths.reserve(group);
  std::array<Ray, group> rays;
  std::array<Hit, group> hits;
  SurfaceVertex vertex;
  // False where the path has come to its end.
  const auto meet = [&](LightPath& path, const Hit& hit) {
    const auto ended = [](uint64_t& count) {
      ++count;
      return false;
    };
    path.sampler.start_vertex(path.segments++);
    if constexpr (std::is_invocable_v<const Handler&, const LightAtGauge&>)
      if (limits.gauges) show_at_gauges(path, hit.t, *limits.gauges, handler);
    if (path.state.medium) {
      if constexpr (std::is_invocable_v<const Handler&, const LightMediumVertex&>) {
        const LightMediumVertex in_medium = sample_medium_vertex(path, hit.t);
        if (!in_medium.flux.is_zero()) handler(in_medium);
      }
      const Medium::Flight flight = fly_through_medium(path, hit.t);
      if (flight.scattered) {
        path.boundaries = 0;
        if constexpr (std::is_invocable_v<const Handler&, const LightMediumEvent&>)
          handler(LightMediumEvent{medium_vertex(path, flight)});
        switch (scatter_in_medium(path, flight, limits)) {
          case MediumFate::scattered:
            return true;
          case MediumFate::absorbed:
            return ended(counts.absorbed_in_media);
          case MediumFate::stopped:
            return ended(counts.stopped);
          case MediumFate::too_long:
            return ended(counts.too_long);
        }
      }
      path.attenuate(flight.weight);
    }
    if (!(hit.t < infinity)) return ended(counts.escaped);
    path.state.footprint.travel(hit.t);
    vertex.meet(scene, path.ray, hit, path.state);
    path.distance += hit.t;
    if (vertex.is_null() || passes_straight(vertex, path)) {
      if (++path.boundaries > most_null_boundaries) return ended(counts.stopped);
      pass_boundary(vertex, path.state, path.ray);
      return true;
    }
    path.boundaries = 0;
    const Lobes follow = handler(LightVertex{.vertex = vertex,
                                             .state = path.state,
                                             .path_class = path.path_class,
                                             .distance = path.distance,
                                             .path = path.index,
                                             .ray = path.ray,
                                             .hit = hit,
                                             .sampler = path.sampler});
    if (!any(follow)) return ended(counts.stopped);
    if (path.path_class.events() >= limits.maximum_events) return ended(counts.too_long);
    if (!scatter_light_path(vertex, follow, limits, path)) return ended(counts.absorbed);
    return true;
  };
  while (begin < end) {
    const uint32_t group_end = begin + std::min(group, end - begin);
    for (; begin < group_end; ++begin)
      if (const std::optional<LightPath> path = emit(begin)) {
        paths.push_back(*path);
        paths.back().index = begin;
      }
    while (!paths.empty()) {
      const size_t count = paths.size();
      for (size_t i = 0; i < count; ++i) rays[i] = paths[i].ray;
      counts.rays += count;
      scene.intersect({rays.data(), count}, hits);
      size_t kept = 0;
      for (size_t i = 0; i < count; ++i) {
        if (!meet(paths[i], hits[i])) continue;
        if (kept != i) paths[kept] = paths[i];
        ++kept;
      }
      paths.erase(paths.begin() + std::ptrdiff_t(kept), paths.end());
    }
  }
  return counts;
}

}  // namespace kaustik
