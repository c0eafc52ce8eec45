#pragma once
#include <vector>

#include "kaustik/integrator/plan_window.h"
#include "kaustik/photon/light_vertices.h"
#include "kaustik/scene/scene.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// A point that a block of pixels shows: the first vertex whose event is not delta.
struct PixelProbe {
  bool found = false;
  Vec2f raster{0, 0};  ///< where it is looked for
  SurfaceVertex vertex;
  float pixel_width = 0;  ///< on the surface, m
  float distance = 0;     ///< from the camera to what is hit first, m
  CameraPathClass path;   ///< of the events before the vertex

  /// Radiance that the vertex of a light path, merging here with a kernel of height 1 and the only
  /// one of its pass, sends to the camera in the wanted components.
  Spectrum sent(const LightVertexData& photon, ComponentSet wanted) const;
};

/// One for each block of `block_size`² pixels, row by row, of that window.
std::vector<PixelProbe> make_pixel_probes(const Scene& scene, const PlanWindow& window,
                                          int block_size);

}  // namespace kaustik
