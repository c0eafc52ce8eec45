#pragma once
#include <array>
#include <cstddef>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Straight lines at which a surface ends within a disk: what lies beyond one does not count.
struct DiskEdges {
  struct Edge {
    Vec3f inward{0, 0, 0};  ///< unit, in the plane of the disk
    float distance = 0;     ///< of the disk's center, m, not negative
  };
  static constexpr size_t most = 4;
  std::array<Edge, most> edges;
  size_t count = 0;

  /// Whether a point of the disk counts, that far from its center.
  bool hold(const Vec3f& offset) const {
    for (size_t i = 0; i < count; ++i)
      if (dot(edges[i].inward, offset) < -edges[i].distance) return false;
    return true;
  }
  /// Whether one of them crosses the disk.
  bool cut(float radius) const {
    for (size_t i = 0; i < count; ++i)
      if (edges[i].distance < radius) return true;
    return false;
  }
};

enum class KernelShape {
  flat,      ///< 1
  parabolic  ///< 1 − distance²/radius² (Epanechnikov)
};

/// Integrals of a kernel's shape, times 1, x, y, x², x y, y², over the part of a disk that edges
/// leave; x and y in the frame of the disk, over its radius.
struct DiskMoments {
  double one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};
DiskMoments disk_moments(const Frame& frame, float radius, const DiskEdges& edges,
                         KernelShape shape);

/// The factor (1 + slope · offset) scale makes the shape a kernel that integrates to 1 over what
/// the edges leave, and finds light that varies linearly there as it is at the center: where a disk
/// has one side alone, its mean is that of a point beside the center (boundary kernels; Gasser,
/// Müller 1979). It may be negative.
struct DiskKernel {
  float scale = 0;       ///< 1/m²
  Vec3f slope{0, 0, 0};  ///< 1/m

  /// For what edges leave of the disk; 0 where that is nothing.
  DiskKernel(const Frame& frame, float radius, const DiskEdges& edges, KernelShape shape);
  /// Leaves out the slope: then only even light is found as it is.
  void level();
  float factor(const Vec3f& offset) const { return 1 + dot(slope, offset); }

 private:
  float even_scale_ = 0;  ///< scale without slope
};

}  // namespace kaustik
