#pragma once
#include "kaustik/transport/illumination_model.h"

namespace kaustik {

/// Unbiased path tracing with next-event estimation and multiple importance sampling; names the
/// component of every contribution. A referee for the biased methods.
class PathIntegrator final : public IlluminationModel {
 public:
  PathIntegrator(const Arguments& arguments, const Scene& scene);
  static const TypeInfo& info();

  /// Through media by free flight, with next-event estimation where it is scattered.
  bool advance(const PassState& state, CameraWalk& walk) const override;
  bool reflect(const PassState& state, CameraWalk& walk,
               const RadianceTracer& tracer) const override;
  /// Samples of one pass stratify one another best.

 private:
  bool goes_on(CameraWalk& walk, float u) const;

  int maximum_events_;
  int roulette_depth_;
};

}  // namespace kaustik
