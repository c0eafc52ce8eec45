#pragma once
#include "kaustik/integrator/integrator.h"

namespace kaustik {

/// Unbiased path tracing with next-event estimation and multiple importance sampling; names the
/// component of every contribution. A referee for the biased methods.
class PathIntegrator final : public Integrator {
 public:
  PathIntegrator(const Arguments& arguments, const Scene& scene);
  static const TypeInfo& info();

  std::unique_ptr<PassState> prepare(const Pass&, SplatBuffer&, std::stop_token,
                                     const ProgressFunction&) const override;
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override;
  /// Passes are independent replicates: only samples of one pass stratify one another.
  uint32_t default_samples_per_pass() const override { return 16; }
  ComponentSet components() const override { return components_; }

 private:
  const Scene& scene_;
  ComponentSet components_;
  int maximum_events_;
  int roulette_depth_;
};

}  // namespace kaustik
