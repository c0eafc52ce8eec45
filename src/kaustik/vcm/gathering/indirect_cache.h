#pragma once
#include "kaustik/irradiance/irradiance_cache.h"
#include "kaustik/transport/camera_walk.h"
#include "kaustik/vcm/gathering/gathered_light.h"

namespace kaustik {

/// How each pass fills its cache.
struct CachePlan {
  int rounds = 0;         ///< from coarse to fine; 0: there is none
  int gather_rays = 128;  ///< of a record
};

/// Diffuse indirect light of a pass where the camera sees matt surfaces: gathered at records, and
/// interpolated between them where it is smooth. Elsewhere it has none, and other techniques have
/// to find that light. Where it has it, it has all of it.
class IndirectCache {
 public:
  /// Rounds in which it is filled, from coarse to fine. Finer ones find little that is smooth.
  static constexpr int most_rounds = 2;
  /// Gather rays of a record that there are at least, and at most.
  static constexpr int least_gather_rays = 64, most_gather_rays = 512;

  /// Empty, for light of set number `set` of the pass. What `inputs` refer to must outlive it. All
  /// lengths shrink as radii do, by the stage of `pass`. Records have so many gather rays.
  IndirectCache(const GatherInputs& inputs, const Pass& pass, size_t set, int gather_rays,
                const std::stop_token& stop = {});

  /// The next of its rounds. Worth nothing if it was stopped. Not while others ask.
  void fill_round(const std::stop_token& stop);

  /// Whether there may ever be light for the walk's vertex: the first of its path, be it mirrored,
  /// without relief, whose diffuse lobe sends light back alike to all sides. Where the number of
  /// events is limited it has none that is mirrored: a record knows nothing of events before it.
  static bool is_for(const CameraWalk& walk, int maximum_events) {
    const SurfaceVertex& vertex = walk.vertex();
    const bool is_first =
        maximum_events < any_number_of_events ? walk.events() == 0 : walk.all_events_delta();
    return is_first && walk.gauge() < 0 && any(vertex.lobes() & Lobes::diffuse) &&
           vertex.is_lambertian() && !vertex.transmits() && !vertex.has_relief();
  }
  /// Takes the walk on to such a vertex, by delta events on its way; false if it finds none.
  static bool advance_to_vertex(CameraWalk& walk, int maximum_events);
  /// Radiance that the diffuse lobe of such a vertex sends back of diffuse indirect light; false if
  /// it has none.
  bool reflected(const CameraWalk& walk, Spectrum& radiance) const;

  /// Traced so far.
  uint64_t rays() const { return light_.rays(); }
  uint64_t rays_dropped() const { return cache_.rays_dropped(); }

 private:
  Sampler numbers(uint64_t address) const;
  std::vector<CachePoint> points_of_round(int stride, const std::stop_token& stop) const;

  GatherInputs in_;
  Pass pass_;
  size_t set_;
  GatheredLight light_;
  IrradianceCache cache_;
  uint32_t round_ = 0;
};

}  // namespace kaustik
