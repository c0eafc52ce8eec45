#pragma once
#include <mutex>

#include "kaustik/transport/integrator.h"
#include "kaustik/vcm/lessons/lessons.h"
#include "kaustik/vcm/plan/plans.h"
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
  Lessons lessons() const override;
  void go_on_with(const Lessons& lessons, LessonUse use) override;
  PassReport learn(const Pass& pass, std::stop_token stop,
                   const ProgressFunction& progress) const override;

 private:
  struct State;
  void trace_sample(const State& state, const Vec2f& raster, Sampler& sampler,
                    SampleSink& sink) const;
  /// `made_up`: passes that had to be traced for it, in whose progress one more part is left.
  std::shared_ptr<const VcmPlans> plans_for(const Pass& pass, std::stop_token stop,
                                            const ProgressFunction& progress, uint32_t& made_up,
                                            PassReport& report) const;
  /// The pass's light paths, and all that samples need of them.
  void trace_light(State& state, const Pass& pass, const PathWeights& weights, SplatBuffer& splats,
                   std::stop_token stop, const ProgressFunction& progress) const;
  /// The plans of the first pass; lessons of the pass's seed and samples are begun unless those
  /// that are there know its epoch. Worth nothing if it was stopped.
  std::shared_ptr<const VcmPlans> begin_lessons(const Pass& pass, const std::stop_token& stop,
                                                PassReport& report) const;
  /// Learns from passes before `until` that were not rendered here: `made_up` of them. False if
  /// that was stopped.
  bool make_up(const Pass& pass, uint32_t until, std::stop_token stop,
               const ProgressFunction& progress, uint32_t& made_up, PassReport& report) const;
  /// A pass that is not rendered here, as far as learning goes.
  void learn_missing(std::shared_ptr<const VcmPlans> plans, const Pass& missing,
                     std::stop_token stop, const ProgressFunction& progress,
                     PassReport& report) const;
  /// Of the next pass, whose light paths `state` has.
  void take_lesson(State& state, const Pass& pass, const std::stop_token& stop) const;
  /// The same if that is the next pass.
  void take_lesson_if_next(State& state, const Pass& pass, const std::stop_token& stop) const;
  LightVertices trace(const VcmPlans& plans, const PathWeights& weights, const Pass& pass,
                      SplatBuffer& splats, std::stop_token stop, const ProgressFunction& progress,
                      PassReport& report) const;
  PathWeights weights_for(const VcmPlans& plans, const Pass& pass) const;
  /// Those for passes of so many samples, made when they are first asked for; worth nothing if that
  /// was stopped.
  std::shared_ptr<const VcmPlans> plans(uint32_t samples_per_pixel, const std::stop_token& stop,
                                        PassReport& report) const;

  const Scene& scene_;
  VcmSettings settings_;
  std::shared_ptr<const LightPathEmission> plain_;  ///< not guided
  mutable std::mutex plans_mutex_;
  mutable std::shared_ptr<const VcmPlans> plans_;
  mutable std::mutex learning_mutex_;
  mutable std::unique_ptr<VcmLessons> lessons_;
  std::shared_ptr<const VcmPlans> fixed_;  ///< of all passes; null: they change with the passes
};

}  // namespace kaustik
