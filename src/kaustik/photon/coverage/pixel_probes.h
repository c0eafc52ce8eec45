#pragma once
#include <vector>

#include "kaustik/scene/scene.h"
#include "kaustik/transport/block_grid.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// A point that a block of pixels shows: the first vertex whose event is not delta.
struct PixelProbe {
  bool found = false;
  Vec2f raster{0, 0};  ///< where it is looked for, in the crop window's raster
  SurfaceVertex vertex;
  float pixel_width = 0;  ///< on the surface, m
  /// From the camera to what is hit first, m; of a camera that sees along parallel lines
  /// CameraTraits::parallel_distance, however far back it stands.
  float distance = 0;
  CameraPathClass path;  ///< of the events before the vertex
  int gauge = -1;        ///< that the vertex is; then it has no width of a pixel, and the distance
                         ///< is that of what lies around; −1: it is on a surface
};

/// One for each block.
std::vector<PixelProbe> make_pixel_probes(const Scene& scene, const BlockGrid& grid);

}  // namespace kaustik
