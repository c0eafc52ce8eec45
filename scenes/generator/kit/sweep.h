#pragma once
// Solids from an outline that is moved: mouldings, frames, banisters, branches, slabs.

#include "kit/primitives.h"

namespace kaustik::scenes {

using Path = std::vector<Vec3d>;

/// Triangles of a simple polygon, counterclockwise, by cutting off ears.
std::vector<std::array<uint32_t, 3>> triangulated(const Curve& outline);

/// Prism over a counterclockwise outline, from height z0 to z1.
Mesh extruded(const Curve& outline, double z0, double z1, double crease_degrees = 35);

struct SweepOptions {
  bool closed_path = false;  ///< the last point joins the first
  double crease_degrees = 35;
  std::function<double(double)> scale = {};  ///< of the outline, over the share of the path 0 … 1
};

/// The counterclockwise outline moved along a path with mitred corners; its y axis starts as near
/// to `up` as can be and turns no more than the path does, its x axis is to the right of the path
/// (direction x up). Open ends are capped. u runs around the outline, v along the path. A closed
/// path should be plane.
Mesh swept(const Curve& outline, const Path& path, const Vec3d& up,
           const SweepOptions& options = {});

/// Round bar along a path; `scale` as above.
Mesh tube(double radius, const Path& path, int segments, const SweepOptions& options = {});

/// Picture frame in the xz plane about the origin around an opening of `width` x `height`: the
/// outline's x runs outward from the opening's edge, its y toward the viewer, who is at -y.
Mesh frame(const Curve& outline, double width, double height);

}  // namespace kaustik::scenes
