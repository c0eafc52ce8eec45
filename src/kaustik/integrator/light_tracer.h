#pragma once
#include <optional>

#include "kaustik/photon/emission/emission.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// Light paths from the lamps, splatted to the camera at every vertex that it sees: unbiased, and
/// the referee for L S⁺ D E, which path tracing cannot find. Caustics have photons of their own,
/// aimed at what is specular by the same code as those of photon maps (`aim` = none is independent
/// of it). What the camera sees by a specular event is out of its reach.
class LightTracer final : public Integrator {
 public:
  LightTracer(const Arguments& arguments, const Scene& scene);
  static const TypeInfo& info();

  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override;
  void sample(const PassState&, const Vec2f&, Sampler&, SampleSink&) const override {}

 private:
  struct Counts;
  /// Photons of one light that are emitted alike.
  struct Job {
    int light;
    bool aimed;      ///< at specular objects, for caustics alone
    uint32_t count;  ///< photons
    ComponentSet wanted;
  };
  std::vector<Job> jobs(uint32_t total) const;
  Counts trace_block(const Pass& pass, const Job& job, uint32_t begin, uint32_t end,
                     SplatBuffer& splats) const;

  const Scene& scene_;
  int maximum_events_;
  EmissionSampler emission_;
  std::optional<EmissionSampler> aimed_emission_;  ///< where there is anything to aim at
  std::vector<double> powers_;
};

}  // namespace kaustik
