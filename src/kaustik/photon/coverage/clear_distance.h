#pragma once
#include "kaustik/photon/coverage/disk_kernel.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// A half space: the points over a plane, as far as a height.
struct SpaceOverPlane {
  Vec3f origin{0, 0, 0};  ///< a point of the plane
  Vec3f normal{0, 0, 1};
  float lowest = 0;   ///< what does not rise so high does not count, m
  float highest = 0;  ///< nor what begins higher, m
};

/// How far around the origin nothing stands over the plane, on the near side of the edges, m: in a
/// smaller disk there, nothing hides two points of the plane from one another. `reach` if nothing
/// was found as far as that; never too much, but maybe too little: of shapes without a mesh it sees
/// the boxes, and it gives up where there are very many triangles.
float clear_distance(const Scene& scene, const SpaceOverPlane& space, const DiskEdges& edges,
                     float reach);

}  // namespace kaustik
