#pragma once
#include <vector>

#include "kaustik/photon/emission/emission.h"

namespace kaustik {

/// What cones and disks are made of: everything of a target is inside.
struct AimSphere {
  Vec3f center;
  float radius = 0;
  float weight = 0;
};

/// At most `limit` targets that hold everything of the given ones: neighbours are merged, where
/// that adds least to the spheres around them. Targets that are empty or weigh nothing are dropped.
std::vector<AimTarget> merge_targets(std::vector<AimTarget> targets, size_t limit);

/// The sphere around a target, widened by rounding errors of coordinates as large as those of
/// `scene_bounds`.
AimSphere bounding_sphere(const AimTarget& target, const Bounds3f& scene_bounds);

/// A spherical shape: every point of a ball's surface is a point of the shape.
struct Ball {
  Vec3f center;
  float radius = 0;
};
/// Whether `shape` is a whole sphere with its normals outward; radius zero if not.
Ball find_ball(const Shape& shape);

}  // namespace kaustik
