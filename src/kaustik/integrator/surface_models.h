#pragma once
#include "kaustik/transport/illumination_model.h"

namespace kaustik {

/// The integrator of the scene, and others as models of single surfaces (Surface::illumination).
/// A surface looks as its own model says wherever the camera sees it, directly or by specular
/// events; the model's path is its own to the end, but for what it sees by specular events, which
/// looks as its own model says in turn. What surfaces send one another by diffuse reflection is the
/// affair of the scene's method, which treats them all alike: photons and gather rays know no
/// models, so that nothing else in the picture changes.
class SurfaceModels final : public Integrator {
 public:
  /// A model and the surfaces that have it.
  struct Model {
    std::unique_ptr<IlluminationModel> model;
    std::vector<uint32_t> surfaces;
  };
  /// `scene` must outlive this.
  SurfaceModels(const Scene& scene, std::unique_ptr<IlluminationModel> of_scene,
                std::vector<Model> of_surfaces);

  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override;
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override;

 private:
  struct State;
  class Tracer;

  const Scene& scene_;
  std::vector<std::unique_ptr<IlluminationModel>> models_;  ///< the first is the scene's
  std::vector<uint32_t> model_of_surface_;                  ///< index into models_
};

}  // namespace kaustik
