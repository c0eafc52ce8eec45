#pragma once
#include "kaustik/transport/camera_walk.h"

namespace kaustik {

/// Finds the radiance along rays: traces them and asks at every surface what it reflects.
class RadianceTracer {
 public:
  virtual ~RadianceTracer() = default;
  /// Follows the walk to its end.
  virtual void follow(CameraWalk& walk) const = 0;
};

/// A method that works from the camera. Radiance along a ray is what CameraWalk::advance() finds on
/// it plus what the surface at its end reflects; the latter is all that a model has to know, and
/// what the model of one surface replaces [Schregle 1998, section 7.1].
class IlluminationModel : public Integrator {
 public:
  /// `scene` must outlive this.
  explicit IlluminationModel(const Scene& scene) : scene_(scene) {}

  /// Takes the walk to the next surface and adds the light that shines into it on the way: from
  /// lamps, and what media scatter. False if there is no surface. A scene has one model for its
  /// media: that of the integrator, whatever models its surfaces have.
  virtual bool advance(const PassState& state, CameraWalk& walk) const;

  /// Adds what the walk's vertex reflects of light that is known there, and for the rest chooses
  /// the walk's next direction: false if there is none. Where several directions are followed,
  /// each is a branch for `tracer`. `state` is of this model's prepare().
  virtual bool reflect(const PassState& state, CameraWalk& walk,
                       const RadianceTracer& tracer) const = 0;
  /// Lobes whose events count as specular.
  virtual Lobes traced() const { return Lobes::specular; }

  /// Nothing, for models that need no light pass.
  std::unique_ptr<PassState> prepare(const Pass&, SplatBuffer&, std::stop_token,
                                     const ProgressFunction&) const override {
    return std::make_unique<PassState>();
  }
  /// This model on all surfaces.
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const final;

 protected:
  const Scene& scene() const { return scene_; }

 private:
  const Scene& scene_;
};

}  // namespace kaustik
