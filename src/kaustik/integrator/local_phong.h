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
  uint32_t default_samples_per_pass() const override { return 16; }
  ComponentSet components() const override { return components_; }

 private:
  ComponentSet components_;
  LocalLight light_;
};

}  // namespace kaustik
