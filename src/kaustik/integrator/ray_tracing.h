#pragma once
#include "kaustik/integrator/local_light.h"

namespace kaustik {

/// Recursive ray tracing (Whitted 1980): local light as LocalPhong, and rays that follow perfect
/// mirrors and refraction, both ways where a surface has both. Glossy surfaces show the lamps
/// alone.
class RayTracing final : public IlluminationModel {
 public:
  RayTracing(const Arguments& arguments, const Scene& scene);
  static const TypeInfo& info();

  bool reflect(const PassState& state, CameraWalk& walk,
               const RadianceTracer& tracer) const override;
  Lobes traced() const override { return Lobes::delta; }

 private:
  bool follow_both_ways(CameraWalk& walk, const RadianceTracer& tracer) const;
  bool follow_one_way(CameraWalk& walk) const;

  LocalLight light_;
  int maximum_events_, roulette_depth_;
};

}  // namespace kaustik
