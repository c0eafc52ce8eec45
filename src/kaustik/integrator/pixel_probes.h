#pragma once
#include <vector>

#include "kaustik/scene/scene.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// A point that a block of pixels shows: the first vertex whose event is not delta.
struct PixelProbe {
  bool found = false;
  Vec2f raster{0, 0};  ///< where it is looked for
  SurfaceVertex vertex;
  float pixel_width = 0;  ///< on the surface, m
  float distance = 0;     ///< from the camera to what is hit first, m
};

/// One for each block of `block_size`² pixels, row by row.
std::vector<PixelProbe> make_pixel_probes(const Scene& scene, const Vec2i& blocks, int block_size);

}  // namespace kaustik
