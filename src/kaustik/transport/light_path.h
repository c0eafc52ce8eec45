#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/path_state.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// A path that is followed from a light, between two surfaces.
struct LightPath {
  LightPath(const Ray& emitted, const Spectrum& flux, Lobes traced, const Sampler& its_sampler)
      : ray(emitted), path_class(traced), sampler(its_sampler) {
    state.mode = TransportMode::flux;
    state.throughput = flux;
  }

  Ray ray;          ///< along which it goes on
  PathState state;  ///< throughput: flux that arrives, W, before any attenuation there
  LightPathClass path_class;
  Sampler sampler;
};

/// A light path's meeting with a surface, as handlers see it.
struct LightVertex {
  const SurfaceVertex& vertex;  ///< mode flux; wo points back along the path
  const PathState& state;
  const LightPathClass& path_class;  ///< the events before this vertex
  float distance;                    ///< from the path's previous vertex, m
};

/// Events after which no light path goes on for certain.
inline constexpr int certain_events = 16;

struct LightPathLimits {
  int maximum_events = 1 << 20;    ///< scattering events
  Lobes traced = Lobes::specular;  ///< lobes whose events count as specular
};

/// What became of light paths.
struct LightPathCounts {
  uint64_t rays = 0;
  uint64_t escaped = 0, absorbed = 0, too_long = 0;
  uint64_t stopped = 0;  ///< by the handler
};

/// Scatters `path` at `vertex`, by the lobes `follow`: true if it goes on. Russian roulette
/// survives with the largest lane of the event's weight, so the flux of the survivors stays even;
/// shared by global, caustic and splatted light [Schregle 1998].
bool scatter_light_path(const SurfaceVertex& vertex, Lobes follow, LightPath& path);

/// Follows the light paths `begin` to `end`. `emit(i)` gives the i-th, or nothing. At every surface
/// `handler(const LightVertex&)` answers with the lobes by which the path may go on (Lobes::none
/// stops it). Some dozens of paths advance side by side: their rays are traced in packets, and the
/// memory that they need is fetched early (`make bench` compares with rays one by one). The order
/// is the same in every run.
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
    if (!(hit.t < infinity)) return ended(counts.escaped);
    vertex.meet(scene, path.ray, hit, TransportMode::flux);
    const Lobes follow = handler(LightVertex{vertex, path.state, path.path_class, hit.t});
    if (!any(follow)) return ended(counts.stopped);
    if (path.path_class.events() >= limits.maximum_events) return ended(counts.too_long);
    if (!scatter_light_path(vertex, follow, path)) return ended(counts.absorbed);
    return true;
  };
  while (begin < end) {
    const uint32_t group_end = begin + std::min(group, end - begin);
    for (; begin < group_end; ++begin)
      if (const std::optional<LightPath> path = emit(begin)) paths.push_back(*path);
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
