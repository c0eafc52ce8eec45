#include "kaustik/vcm/vcm.h"

namespace kaustik {

struct VcmIntegrator::State final : PassState {
  State(const Scene& scene, const VcmSettings& settings, std::shared_ptr<const VcmPlans> plans,
        const Pass& of_pass)
      : pass(scene, settings, std::move(plans), of_pass) {}

  VcmPass pass;
};

VcmIntegrator::VcmIntegrator(const Arguments& arguments, const Scene& scene)
    : scene_(scene),
      settings_(settings_for(scene, arguments)),
      learning_(scene_, settings_,
                std::make_shared<const LightPathEmission>(scene, settings_.aim)) {
  traits_ = {.splats = settings_.techniques.splats,
             .estimates_bias = settings_.techniques.merging,
             .components = settings_.components,
             .default_samples_per_pass = settings_.samples_per_pass};
}

std::unique_ptr<PassState> VcmIntegrator::prepare(const Pass& pass, SplatBuffer& splats,
                                                  std::stop_token stop,
                                                  const ProgressFunction& progress) const {
  PassReport report;
  const PassPlans found = learning_.plans_for(pass, stop, progress, report);
  auto state = std::make_unique<State>(scene_, settings_, found.plans, pass);
  state->report = std::move(report);
  const VcmPlans& plans = *found.plans;
  state->report.decisions = plans.decisions;
  state->report.warnings = settings_.warnings;
  if (!plans.techniques.any())
    state->report.warnings.emplace_back(
        "all techniques are switched off: only lights that the camera sees straight are there; "
        "switch on unidirectional, next_event, splats, connections or merging");
  state->pass.trace_light({.remembered_paths = found.remembered_paths}, splats, stop,
                          part_of(progress, found.made_up, found.made_up + 1), state->report);
  if (!stop.stop_requested()) learning_.learn_from(state->pass, stop, state->report.rays);
  return state;
}

PixelSamples VcmIntegrator::pixel_samples(const PassState& state, const Pass& pass,
                                          const Vec2i& pixel) const {
  const VcmPlans& plans = state_as<State>(state).pass.plans();
  const SampleSpread* spread = plans.pixels.spread().get();
  // Fixed plans may be of passes with another number of samples.
  if (!spread || plans.samples_per_pixel != pass.samples_per_pixel)
    return Integrator::pixel_samples(state, pass, pixel);
  const size_t block = plans.pixels.seen().grid().index_at(Vec2f(float(pixel.x), float(pixel.y)));
  const uint32_t count = spread->counts[block];
  // Orders have sequences of their own.
  if (pass.is_regional()) return {pass.round() * count, count};
  const uint32_t rounds = (pass.index - spread->begin) / replicate_count;
  return {spread->first_indices[block] + rounds * count, count};
}

void VcmIntegrator::sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
                           SampleSink& sink) const {
  state_as<State>(state).pass.sample(raster, sampler, sink);
}

}  // namespace kaustik
