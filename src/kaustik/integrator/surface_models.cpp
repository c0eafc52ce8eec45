#include "kaustik/integrator/surface_models.h"

namespace kaustik {

struct SurfaceModels::State final : PassState {
  std::vector<std::unique_ptr<PassState>> states;  ///< parallel to models_
};

/// Follows walks that start in the hands of one of the models.
class SurfaceModels::Tracer final : public RadianceTracer {
 public:
  Tracer(const SurfaceModels& all, const State& state, uint32_t model)
      : all_(all), state_(state), model_(model) {}

  void follow(CameraWalk& walk) const override {
    uint32_t model = model_;
    // Media have one model, whoever sees them.
    while (all_.models_[0]->advance(*state_.states[0], walk)) {
      if (walk.gauge() < 0 && walk.all_events_specular())
        model = all_.model_of_surface_[walk.vertex().point().shape];
      if (!all_.models_[model]->reflect(*state_.states[model], walk, Tracer(all_, state_, model)))
        return;
    }
  }

 private:
  const SurfaceModels& all_;
  const State& state_;
  uint32_t model_;
};

SurfaceModels::SurfaceModels(const Scene& scene, std::unique_ptr<IlluminationModel> of_scene,
                             std::vector<Model> of_surfaces)
    : scene_(scene), model_of_surface_(scene.surface_count(), 0) {
  traits_ = of_scene->traits();
  models_.push_back(std::move(of_scene));
  for (Model& model : of_surfaces) {
    for (const uint32_t surface : model.surfaces)
      model_of_surface_[surface] = uint32_t(models_.size());
    models_.push_back(std::move(model.model));
  }
}

std::unique_ptr<PassState> SurfaceModels::prepare(const Pass& pass, SplatBuffer& splats,
                                                  std::stop_token stop,
                                                  const ProgressFunction& progress) const {
  auto state = std::make_unique<State>();
  for (size_t i = 0; i < models_.size(); ++i) {
    state->states.push_back(models_[i]->prepare(pass, splats, stop, [&](double share) {
      if (progress) progress((double(i) + share) / double(models_.size()));
    }));
    PassReport& report = state->states.back()->report;
    state->report.rays += report.rays;
    state->report.photons += report.photons;
    for (std::string& warning : report.warnings)
      state->report.warnings.push_back(std::move(warning));
  }
  return state;
}

void SurfaceModels::sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
                           SampleSink& sink) const {
  CameraWalk walk(scene_, raster, sampler, sink, models_[0]->traced());
  Tracer(*this, state_as<State>(state), 0).follow(walk);
}

}  // namespace kaustik
