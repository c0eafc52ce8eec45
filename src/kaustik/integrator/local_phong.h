#pragma once
#include "kaustik/integrator/local_light.h"

namespace kaustik {

/// The local illumination model (Phong 1975): direct light by the surface's own bsdf, and ambient
/// light. Sees no mirror images and no light that surfaces send one another.
class LocalPhong final : public IlluminationModel {
 public:
  LocalPhong(const Arguments& arguments, const Scene& scene);
  static const TypeInfo& info();

  bool reflect(const PassState& state, CameraWalk& walk,
               const RadianceTracer& tracer) const override;
  Lobes traced() const override { return Lobes::delta; }

 private:
  LocalLight light_;
};

}  // namespace kaustik
