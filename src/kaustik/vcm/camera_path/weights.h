#pragma once
#include "kaustik/vcm/camera_path/vertices.h"

namespace kaustik {

/// Weighs light that a camera path samples or meets against all other ways of finding it.
class CameraPathWeights final : public LightWeights {
 public:
  /// `vertices` must outlive this, and tell of the walk whose light is weighed. Without
  /// `light_paths` light is weighed as if there were none.
  CameraPathWeights(const CameraPathInputs& inputs, CameraVertices& vertices,
                    bool light_paths = true)
      : in_(inputs), vertices_(vertices), light_paths_(light_paths) {}

  float sampled(const Scatterer& vertex, const DirectLight& light) override;
  float met(int light, const SurfaceVertex& vertex) override;
  float met(int light, const Ray& ray) override;

 private:
  /// Whether light is only sampled and met by chance on paths of one segment more.
  bool path_tracing_alone() const;
  /// Density of sampling the light from the last vertex at `where`, a point or a direction; 0: it
  /// is not sampled there.
  template <typename Where>
  float next_event_density(int light, const Where& where) const;
  /// Weight of meeting a light that is sampled with the density `next_event` per solid angle, where
  /// paths are traced alone.
  float met_weight_alone(float next_event) const;
  /// Weight of meeting the light at `on_light`; `to_last` turns a density per solid angle there
  /// into that of the last vertex.
  float met_weight(const PathVertex& on_light, const EmissionDensity& emission, float to_last,
                   float next_event);

  const CameraPathInputs& in_;
  CameraVertices& vertices_;
  bool light_paths_;
};

}  // namespace kaustik
