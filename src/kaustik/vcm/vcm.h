#pragma once
#include "kaustik/transport/integrator.h"
#include "kaustik/vcm/learning.h"
#include "kaustik/vcm/settings.h"

namespace kaustik {

/// Vertex connection and merging (Georgiev et al. 2012; Hachisuka et al. 2012): paths from the
/// camera and paths from the lights, combined by all techniques that are switched on. Its presets
/// `bdpt` and `ppm` differ in these alone.
class VcmIntegrator final : public Integrator {
 public:
  VcmIntegrator(const Arguments& arguments, const Scene& scene);

  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override;
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override;
  PixelSamples pixel_samples(const PassState& state, const Pass& pass,
                             const Vec2i& pixel) const override;
  Lessons lessons() const override { return learning_.lessons(); }
  void go_on_with(const Lessons& lessons, LessonUse use) override {
    learning_.go_on_with(lessons, use);
  }
  SharedLessons* share_lessons() const override { return learning_.share(); }
  PassReport learn(const Pass& pass, std::stop_token stop,
                   const ProgressFunction& progress) const override {
    return learning_.learn(pass, stop, progress);
  }

 private:
  struct State;

  const Scene& scene_;
  VcmSettings settings_;
  mutable VcmLearning learning_;
};

}  // namespace kaustik
