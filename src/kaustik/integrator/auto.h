#pragma once
#include "kaustik/integrator/integrator.h"

namespace kaustik {

/// The default: a method for the scene, which needs no parameter: paths from the camera and light
/// paths that merge with them, how many and where being chosen by a pilot
/// (VcmSettings::chooses_light_paths). Says what it chose
/// (PassReport::decisions).
class AutoIntegrator final : public Integrator {
 public:
  AutoIntegrator(const Arguments& arguments, const Scene& scene);
  static const TypeInfo& info();

  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override;
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override {
    method_->sample(state, raster, sampler, sink);
  }
  PixelSamples pixel_samples(const PassState& state, const Pass& pass,
                             const Vec2i& pixel) const override {
    return method_->pixel_samples(state, pass, pixel);
  }
  bool splats() const override { return method_->splats(); }
  uint32_t default_samples_per_pass() const override { return method_->default_samples_per_pass(); }
  ComponentSet components() const override { return method_->components(); }
  bool estimates_bias() const override { return method_->estimates_bias(); }

 private:
  std::unique_ptr<Integrator> method_;
};

}  // namespace kaustik
