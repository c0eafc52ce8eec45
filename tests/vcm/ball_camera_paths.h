#pragma once
#include <memory>

#include "kaustik/vcm/camera_path/camera_path.h"
#include "tests/vcm/hollow_ball.h"

namespace kaustik::test {

/// Sums over the lanes.
inline double light_in(const SampleSink& sink, Component component) {
  return double(sink.radiance(component).sum());
}
inline double light_in(const SampleSink& sink) {
  double sum = 0;
  for (int c = 0; c < component_count; ++c) sum += light_in(sink, Component(c));
  return sum;
}

/// What the camera paths of a pass in the ball go by.
class BallCameraPaths {
 public:
  static constexpr float samples = 4;  ///< per pixel

  /// `plan` is that of every pixel.
  BallCameraPaths(const HollowBall& ball, const PathWeights& weights, const PixelPlan& plan)
      : ball_(ball), weights_(weights), plan_(plan), plans_(ball.scene()) {
    plans_ = plans_.with(std::vector<PixelPlan>(plans_.plans().size(), plan));
  }
  /// Traces the light paths of pass `number`.
  void begin(uint32_t paths, uint32_t number, int most_events) {
    number_ = number;
    splats_ = std::make_unique<SplatBuffer>(ball_.scene().film(), ComponentSet::all());
    light_ = ball_.trace(weights_, paths, number, most_events, *splats_, plans_, samples);
    matt_ = MattMerging(light_, weights_);
    tails_ = LightTails(light_, weights_);
    inputs_ = std::make_unique<CameraPathInputs>(CameraPathInputs{
        .scene = ball_.scene(),
        .emission = ball_.emission(),
        .weights = weights_,
        .light = light_,
        .matt = matt_,
        .tails = &tails_,
        .seen = plans_.seen(),
        .camera_samples = samples,
        .connection_scale = float(double(light_.connectible.size()) / double(paths)),
        .merge_radius_sq = weights_.settings().merge_area * inv_pi,
        .maximum_events = most_events});
  }
  const CameraPathInputs& inputs() const { return *inputs_; }
  const PixelPlan& plan() const { return plan_; }
  const LightVertices& light() const { return light_; }

  /// look(raster, sampler) at one sample of each pixel.
  template <typename Look>
  void for_samples(const Look& look) const {
    for (int y = 0; y < HollowBall::pixels; ++y)
      for (int x = 0; x < HollowBall::pixels; ++x) {
        Sampler sampler =
            Sampler::at(2, number_, Stream::camera, uint64_t(y * HollowBall::pixels + x), 0);
        const Vec2f u = sampler.next_2d();
        look(Vec2f(float(x) + u.x, float(y) + u.y), sampler);
      }
  }
  /// Mean over the pixels of what light paths have splatted.
  double splatted() const {
    double sum = 0;
    for (int y = 0; y < HollowBall::pixels; ++y)
      for (int x = 0; x < HollowBall::pixels; ++x)
        for (int c = 0; c < component_count; ++c)
          sum += double(splats_->value(x, y, Component(c)).sum());
    return sum / double(HollowBall::pixels * HollowBall::pixels);
  }

 private:
  const HollowBall& ball_;
  PathWeights weights_;
  PixelPlan plan_;
  PixelPlans plans_;
  uint32_t number_ = 0;
  std::unique_ptr<SplatBuffer> splats_;
  LightVertices light_;
  MattMerging matt_;
  LightTails tails_;
  std::unique_ptr<CameraPathInputs> inputs_;
};

}  // namespace kaustik::test
