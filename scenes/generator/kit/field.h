#pragma once
// Solids from signed distance fields, for sculpture.

#include "kit/mesh.h"

namespace kaustik::scenes {

/// Distance in metres to a surface, negative inside; may be approximate away from it.
using Field = std::function<double(const Vec3d&)>;

double distance_to_ball(const Vec3d& p, const Vec3d& center, double radius);
/// About exact near the surface.
double distance_to_ellipsoid(const Vec3d& p, const Vec3d& center, const Vec3d& radii);
/// A bar from a to b, with a ball of its radius at either end.
double distance_to_bar(const Vec3d& p, const Vec3d& a, double radius_a, const Vec3d& b,
                       double radius_b);
double distance_to_box(const Vec3d& p, const Vec3d& center, const Vec3d& half, double rounding);
/// Union that fills the joint over a width of about `blend` metres.
double blended(double a, double b, double blend);
/// `a` without `b`, the edge rounded over about `blend` metres.
double carved(double a, double b, double blend);

/// The surface of `field` within the box as a closed mesh with one vertex per crossed cell of edge
/// `cell` metres (surface nets), moved onto the surface; normals from the field's gradient. The
/// solid must lie inside the box (throws std::invalid_argument).
Mesh contoured(const Field& field, const Vec3d& low, const Vec3d& high, double cell);

}  // namespace kaustik::scenes
