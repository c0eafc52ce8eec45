#pragma once
#include <array>
#include <memory>

#include "kaustik/transport/integrator.h"
#include "kaustik/vcm/gathering/indirect_cache.h"
#include "kaustik/vcm/light_vertices.h"
#include "kaustik/vcm/merging/light_tails.h"
#include "kaustik/vcm/merging/matt_merging.h"
#include "kaustik/vcm/merging/medium_disks.h"
#include "kaustik/vcm/plan/plans.h"
#include "kaustik/vcm/settings.h"

namespace kaustik {

/// What is made of the light paths of a pass.
struct LightPathAims {
  bool splats = true;             ///< they are splatted, if that is a technique
  bool connections = true;        ///< and may be connected
  bool cache = true;              ///< the cache is filled, if the plans have one
  uint32_t remembered_paths = 0;  ///< paths whose beginnings are remembered
};

/// A pass of connection and merging: its plans, its weights, its light paths once they have been
/// traced, and its camera samples. Stays where it is made.
class VcmPass {
 public:
  /// Without light paths. `scene` and `settings` must outlive this.
  VcmPass(const Scene& scene, const VcmSettings& settings, std::shared_ptr<const VcmPlans> plans,
          const Pass& pass);
  VcmPass(const VcmPass&) = delete;
  VcmPass& operator=(const VcmPass&) = delete;

  /// The pass's light paths, if the plans have any, and all that samples need of them. Counts rays
  /// and vertices. Worth nothing if it was stopped.
  void trace_light(const LightPathAims& aims, SplatBuffer& splats, std::stop_token stop,
                   const ProgressFunction& progress, PassReport& report);
  /// A camera sample at a place of the film's raster.
  void sample(const Vec2f& raster, Sampler& sampler, SampleSink& sink) const;

  const VcmPlans& plans() const { return *plans_; }
  const Pass& pass() const { return pass_; }
  /// Of the first set of wavelengths.
  const LightVertices& light() const { return sets_[0].vertices; }
  std::vector<const LightVertices*> light_of_sets() const;

 private:
  /// The light paths of a set of wavelengths, and what samples of the same set need of them.
  struct LightOfSet {
    LightVertices vertices;
    MattMerging matt;
    LightTails tails;
    SidedTree<LightVertexData> focused;    ///< focused_vertices() of it, if there is a cache, …
    MattMerging focused_matt;              ///< … and merging with them
    std::unique_ptr<IndirectCache> cache;  ///< null: there is none
    float connection_scale = 0;
  };

  /// Light paths of each set of wavelengths.
  uint32_t light_paths_of_set() const;
  PathWeights make_weights() const;
  void trace_set(size_t set, const LightPathAims& aims, SplatBuffer& splats, std::stop_token stop,
                 const ProgressFunction& progress, PassReport& report);
  void fill_cache(size_t set, const std::stop_token& stop, PassReport& report);
  /// Whether first vertices choose their plans, PixelPlans::at().
  bool goes_by_surfaces() const;

  /// Of the first vertices of paths that begin at gauges, as the plans have it.
  GaugeDisks make_gauge_disks(uint64_t& rays) const;

  const Scene& scene_;
  const VcmSettings& settings_;
  std::shared_ptr<const VcmPlans> plans_;
  Pass pass_;
  PathWeights weights_;
  float shrinkage_;    ///< of the disks of merging since the first pass
  MediumDisks media_;  ///< shrunk
  GaugeDisks gauges_;
  std::array<LightOfSet, WavelengthSets::most> sets_;
};

}  // namespace kaustik
