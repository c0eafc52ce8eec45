#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/transport/integrator.h"
#include "kaustik/vcm/gathering/indirect_cache.h"
#include "kaustik/vcm/lessons/light_path_emission.h"
#include "kaustik/vcm/lessons/light_path_use.h"
#include "kaustik/vcm/light_vertices.h"
#include "kaustik/vcm/merging/medium_disks.h"
#include "kaustik/vcm/plan/cache_trial.h"
#include "kaustik/vcm/plan/efficiency.h"
#include "kaustik/vcm/plan/pixel_plans.h"
#include "kaustik/vcm/settings.h"

namespace kaustik {

class RadiusLearning;

/// What the paths of a pilot pass tell of each probe.
struct VcmPilot {
  std::vector<ProbeStatistics> probes;
  std::vector<float> areas;  ///< of the disks that they were taken with, m²
  PassCosts costs;
  /// Of one round, of two …; without probes: not tried.
  std::array<CacheTrial, IndirectCache::most_rounds> cache_trials;
  bool has_tried(int cache_rounds) const {
    return cache_rounds == 0 || !cache_trials[size_t(cache_rounds) - 1].served.empty();
  }
  /// Of a probe, of all of them, and of passes, that fill their cache so.
  ProbeStatistics probe_with(const CachePlan& cache, size_t probe) const;
  std::vector<ProbeStatistics> probes_with(const CachePlan& cache) const;
  PassCosts costs_with(const CachePlan& cache) const;
  /// What choose_plans() expects, by some of the probes all over the picture: enough of them to
  /// compare. `scales` by probe.
  Efficiency expected(const CachePlan& cache, const std::vector<MergeScale>& scales,
                      const PlanChoices& choices) const;
  /// The same with a cache that has its light everywhere, costs nothing and has no noise.
  Efficiency expected_with_ideal_cache(const std::vector<MergeScale>& scales,
                                       const PlanChoices& choices) const;
  float light_paths = 0;   ///< per camera sample, of the passes that it speaks of
  double light_share = 1;  ///< the pilot's light paths over those of such a pass
  /// Light arrives somewhere in the scene that no path from the camera can find, or media scatter
  /// it, of which the pilot knows nothing.
  bool needs_merging = false;
};

/// Where light paths begin, and where they go on from matt surfaces.
struct LightGuides {
  std::shared_ptr<const LightPathEmission> emission;
  std::shared_ptr<const ScatterGuide> scattering = nullptr;  ///< null: not guided
  /// Noise times rays of what is scattered by a guide, relative to that without, in the pilot's
  /// last trial.
  double noise_of_guided = 1;

  /// The same by what was learned.
  LightGuides guided_by(const LightPathUse& learned, const std::stop_token& stop = {}) const;
};

/// What connection and merging know before a pass, from pilot passes and from finished ones.
struct VcmPlans {
  uint32_t samples_per_pixel = 0;
  LightGuides guides;
  Techniques techniques;
  float light_paths = 0;  ///< per camera sample
  PixelPlans pixels;
  MediumDisks media;                      ///< of the first pass
  std::shared_ptr<const VcmPilot> pilot;  ///< null: nothing merges
  std::vector<std::string> decisions;     ///< what was chosen by itself, for the user
  /// Vertices that may be connected, per light path: what the weights go by.
  float connectible_per_path = 1;
  PlanChoices choices;  ///< what the pilot is asked for
  CachePlan cache;      ///< of each pass

  /// Gives the probes these disks and what the pilot is asked for, for passes whose disks have
  /// `shrinkage` times the area.
  Efficiency settle(std::vector<PixelPlan> disks, float shrinkage);
  /// What it would expect, by VcmPilot::expected().
  Efficiency expected(const std::vector<PixelPlan>& disks, float shrinkage) const {
    return pilot->expected(cache, merge_scales(disks, shrinkage), choices);
  }
  /// How merging in such disks differs from the pilot's, by probe.
  std::vector<MergeScale> merge_scales(const std::vector<PixelPlan>& disks, float shrinkage) const;
  /// The same for passes from 0 on, the first of which has what the pass after `passes` would have.
  VcmPlans begun_anew(uint32_t passes) const;
};

/// What the planner has found out.
struct FirstPlans {
  std::shared_ptr<const VcmPlans> plans;
  /// What the light paths of the pilot passes taught; null: they are not guided.
  std::shared_ptr<const LightPathUse> use = nullptr;
  /// What the first radii were learned with; null: nothing.
  std::shared_ptr<const RadiusLearning> radii = nullptr;
  uint64_t rays = 0;  ///< that it took
};

/// Light paths of a pass of a picture of that size, with so many per camera sample.
uint32_t light_path_count(const Vec2i& size, uint32_t samples_per_pixel, float light_paths);
/// The same of what the film shows. A crop window gets the light paths of the whole picture, for
/// disks are as wide as light paths are few and their bias is to be the same in all parts; but no
/// more than some times those of its own size, and no more than memory may well go.
uint32_t light_path_count(const FilmSettings& film, uint32_t samples_per_pixel, float light_paths);

/// Makes the plans of the first pass, by pilot passes.
class VcmPlanner {
 public:
  /// `plain` is not guided. All must outlive this.
  VcmPlanner(const Scene& scene, const VcmSettings& settings,
             const std::shared_ptr<const LightPathEmission>& plain)
      : scene_(scene), settings_(settings), plain_(plain) {}

  /// Worth nothing if it was stopped.
  FirstPlans make(uint32_t samples_per_pixel, const std::stop_token& stop) const;

 private:
  /// Per camera sample, before a pilot tells what pays.
  float light_paths_asked_for(uint32_t samples_per_pixel) const;
  /// The light paths of a pilot pass.
  struct PilotLight {
    LightGuides guides;
    std::shared_ptr<const GaugeDisks> gauges;  ///< null: there are none
    LightVertices vertices;
    uint64_t rays = 0;
  };
  /// What pilot passes have found: guides, and light that goes by them, which tells all else.
  struct FoundLight {
    PilotLight light;
    std::shared_ptr<LightPathUse> use = nullptr;  ///< null: not guided
    uint64_t rays = 0;                            ///< of all pilot passes
  };
  /// By pilot passes of so many paths.
  FoundLight search_light(uint32_t count, const std::stop_token& stop) const;
  /// The same with scattering guided, too, if that leaves less noise. The pilot passes are numbered
  /// from `round` on.
  FoundLight guide_scattering(FoundLight found, uint32_t round, uint32_t count,
                              const std::stop_token& stop) const;
  PilotLight trace_pilot(const LightGuides& guides, uint32_t round, uint32_t count,
                         const std::stop_token& stop) const;
  /// The same plans with disks of merging, a pilot, and what that tells; `use` is up to the caller.
  FirstPlans with_merging(VcmPlans plans, const PilotLight& light, uint32_t of_pass,
                          const std::stop_token& stop) const;
  /// By the disks of `plans`. Counts the rays.
  VcmPilot make_pilot(const VcmPlans& plans, const PilotLight& light, uint32_t light_paths,
                      const std::stop_token& stop, uint64_t& rays) const;

  /// Whether an ideal cache would pay. `scales`: of the pilot's own disks.
  bool is_cache_worth_a_trial(const VcmPilot& pilot, const std::vector<MergeScale>& scales) const;
  /// Tries the cache, as many rounds as may pay: what it serves, with what noise, and what it
  /// costs. `scales`: of the pilot's own disks.
  void try_caches(TrialCaches& caches, const std::vector<MergeScale>& scales, VcmPilot& pilot,
                  const std::stop_token& stop) const;
  /// Efficiency::time() with a cache of so many rounds.
  double expected_time(const VcmPilot& pilot, const std::vector<MergeScale>& scales,
                       int cache_rounds) const;

  const Scene& scene_;
  const VcmSettings& settings_;
  const std::shared_ptr<const LightPathEmission>& plain_;
};

/// What counts as near in the weights of merging, by the distances from the camera, m².
float accepted_area(const PixelPlans& pixels);

}  // namespace kaustik
