#pragma once
#include "kaustik/transport/integrator.h"

namespace kaustik {

struct IntegratorType {
  const TypeInfo& info;
  bool is_model;  ///< an IlluminationModel, which single surfaces may have as their own
  /// `scene` must outlive the integrator.
  std::unique_ptr<Integrator> (*create)(const Arguments&, const Scene& scene);
  /// It follows paths from the camera alone: light of lamps that no path can meet (point, spot,
  /// directional) it never finds behind glass.
  bool is_from_camera_alone = false;
  /// It knows what arrives at points in the air (Camera::gauges()).
  bool knows_gauges = false;
};
/// "auto", "path", "lighttracer", "photonmap", "vcm", "bdpt", "ppm", "localphong", "raytracing".
/// Other renderers' names are foreign_integrators().
const std::vector<IntegratorType>& integrator_types();

}  // namespace kaustik
