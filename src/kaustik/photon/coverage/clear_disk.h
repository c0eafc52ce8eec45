#pragma once
#include <cmath>

#include "kaustik/photon/coverage/disk_kernel.h"

namespace kaustik {

/// A disk in a plane over which nothing stands, as far as edges leave it: from its center all its
/// points are seen. What rises less than half of its flatness does not count.
struct ClearDisk {
  Vec3f normal{0, 0, 0};  ///< unit, on the side that is clear
  float radius = 0;       ///< m; 0: nothing is known to be clear
  float flatness = 0;     ///< how far from the center's plane its points may lie, m
  DiskEdges edges;

  /// Whether nothing hides a point of a surface that lies so far from the center.
  bool holds(const Vec3f& offset) const {
    return length_sq(offset) <= sqr(radius) && std::fabs(dot(offset, normal)) <= flatness &&
           edges.hold(offset);
  }
};

}  // namespace kaustik
