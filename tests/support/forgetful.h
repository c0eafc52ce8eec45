#pragma once
#include "kaustik/transport/integrator.h"

namespace kaustik::test {

/// An error in a method: one of the numbers of a pass does not get into its light pass.
class ForgetfulIntegrator final : public Integrator {
 public:
  enum class Forgets { seed, index };
  /// `right` must outlive this.
  ForgetfulIntegrator(const Integrator& right, Forgets forgets) : right_(right), forgets_(forgets) {
    traits_.components = right.traits().components;
  }
  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override {
    Pass wrong = pass;
    (forgets_ == Forgets::seed ? wrong.seed = 0 : wrong.index = 0);
    return right_.prepare(wrong, splats, stop, progress);
  }
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override {
    right_.sample(state, raster, sampler, sink);
  }

 private:
  const Integrator& right_;
  Forgets forgets_;
};

}  // namespace kaustik::test
