#pragma once
#include <mutex>

#include "kaustik/integrator/efficiency.h"
#include "kaustik/integrator/integrator.h"
#include "kaustik/integrator/light_path_use.h"
#include "kaustik/integrator/pixel_plans.h"
#include "kaustik/integrator/vcm_settings.h"
#include "kaustik/photon/light_path_emission.h"
#include "kaustik/photon/light_vertices.h"

namespace kaustik {

/// Vertex connection and merging (Georgiev et al. 2012; Hachisuka et al. 2012): paths from the
/// camera and paths from the lights, combined by all techniques that are switched on. Its presets
/// `bdpt` and `ppm` differ in these alone.
class VcmIntegrator final : public Integrator {
 public:
  VcmIntegrator(const Arguments& arguments, const Scene& scene);
  ~VcmIntegrator() override;

  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override;
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override;
  bool splats() const override { return settings_.techniques.splats; }
  uint32_t default_samples_per_pass() const override { return settings_.samples_per_pass; }
  ComponentSet components() const override { return settings_.components; }
  bool estimates_bias() const override { return settings_.techniques.merging; }

 private:
  struct State;
  /// The light paths of a pilot pass.
  struct PilotLight {
    std::shared_ptr<const LightPathEmission> emission;
    LightVertices vertices;
    uint64_t rays = 0;
  };
  /// What the pilot's paths tell of each probe.
  struct Pilot {
    std::vector<ProbeStatistics> probes;
    std::vector<float> areas;  ///< of the disks that they were taken with, m²
    PassCosts costs;
    float light_paths = 0;  ///< per camera sample, of the passes that it speaks of
  };
  /// What is learned from pilot passes, and from finished ones.
  struct Plans {
    uint32_t samples_per_pixel = 0;
    std::shared_ptr<const LightPathEmission> emission;
    Techniques techniques;
    float light_paths = 0;  ///< per camera sample
    PixelPlans pixels;
    std::shared_ptr<const Pilot> pilot;  ///< null: nothing merges
    uint64_t pilot_rays = 0;
    std::string decision;  ///< what was chosen by itself, for the user; empty: nothing
    /// Vertices that may be connected, per light path: what the weights go by.
    float connectible_per_path = 1;
    /// Of the light paths of the pilot passes; null: emission is not guided.
    std::shared_ptr<const LightPathUse> use;
  };
  /// What finished passes of a seed have taught: plans change at passes 1, 2, 4, 8 …, from the sums
  /// of all passes before.
  struct Learning;
  /// Of a pass, with so many per camera sample.
  uint32_t light_path_count(uint32_t samples_per_pixel, float light_paths) const;
  /// Emission, and the light paths that tell all else, of pilot passes of so many paths.
  PilotLight search_light(Plans& plans, uint32_t count) const;
  LightVertices trace_pilot(const LightPathEmission& emission, uint32_t round, uint32_t count,
                            PassReport& report) const;
  std::shared_ptr<const Pilot> make_pilot(Plans& plans, const PilotLight& light,
                                          uint32_t light_paths) const;
  /// Gives the probes these disks and, as the pilot tells, chances of going on.
  static Efficiency settle(Plans& plans, std::vector<PixelPlan> pixels);
  /// Settles how many light paths there are, if any, and says so.
  static void choose_light_paths(Plans& plans);
  bool learns_radii(const Plans& plans) const {
    return plans.techniques.merging && !(settings_.radius > 0);
  }
  /// Passes that are learned from; 0: none.
  uint32_t learned_passes(const Plans& plans) const;
  /// First pass of the epoch that a pass belongs to: 0, 1, 2, 4, 8 …
  uint32_t epoch_begin(uint32_t pass, const Plans& plans) const;
  uint32_t remembered_paths(const Pass& pass) const;
  /// `made_up`: passes that had to be traced for it, in whose progress one more part is left.
  std::shared_ptr<const Plans> plans_for(const Pass& pass, std::stop_token stop,
                                         const ProgressFunction& progress, uint32_t& made_up,
                                         PassReport& report) const;
  void learn_from(const LightVertices& light, const Pass& pass) const;
  LightVertices trace(const Plans& plans, const PathWeights& weights, const Pass& pass,
                      SplatBuffer& splats, std::stop_token stop, const ProgressFunction& progress,
                      PassReport& report) const;
  PathWeights weights_for(const Plans& plans, const Pass& pass) const;
  std::shared_ptr<const Plans> make_plans(uint32_t samples_per_pixel) const;
  /// Those for passes of so many samples, made when they are first asked for.
  std::shared_ptr<const Plans> plans(uint32_t samples_per_pixel, PassReport& report) const;

  const Scene& scene_;
  VcmSettings settings_;
  std::shared_ptr<const LightPathEmission> plain_;  ///< not guided
  mutable std::mutex plans_mutex_;
  mutable std::shared_ptr<const Plans> plans_;
  mutable std::mutex learning_mutex_;
  mutable std::unique_ptr<Learning> learning_;
};

}  // namespace kaustik
