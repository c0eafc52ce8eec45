#include "kaustik/transport/illumination_model.h"

namespace kaustik {
namespace {

/// One model for all surfaces.
class SingleModel final : public RadianceTracer {
 public:
  SingleModel(const IlluminationModel& model, const PassState& state)
      : model_(model), state_(state) {}
  void follow(CameraWalk& walk) const override {
    while (model_.advance(state_, walk) && model_.reflect(state_, walk, *this)) {
    }
  }

 private:
  const IlluminationModel& model_;
  const PassState& state_;
};

}  // namespace

bool IlluminationModel::advance(const PassState&, CameraWalk& walk) const { return walk.advance(); }

void IlluminationModel::sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
                               SampleSink& sink) const {
  CameraWalk walk(scene_, raster, sampler, sink, traced());
  SingleModel(*this, state).follow(walk);
}

}  // namespace kaustik
