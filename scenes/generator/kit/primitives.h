#pragma once
// Closed solids with shaded normals and texture coordinates in [0, 1] (unless said otherwise), in
// metres, z up.

#include "kit/mesh.h"

namespace kaustik::scenes {

/// Points of a plane curve: (radius, height) of a profile, (x, y) of an outline.
using Curve = std::vector<Vec2d>;

Mesh box(const Vec3d& low, const Vec3d& high);
/// A box whose edges are rounded with radius `bevel` in `steps` steps per face.
Mesh bevelled_box(const Vec3d& low, const Vec3d& high, double bevel, int steps = 1);

/// Surface of revolution about z of a profile of (radius, height) with the solid on its left as it
/// is walked: upward along the outside. Ends on the axis (radius 0), or is a loop (its last point
/// joins the first) when `loop`. Profile edges that turn by more than `crease_degrees` stay sharp.
/// u runs around, v along the profile. Throws std::invalid_argument for negative radii and for
/// open ends.
Mesh revolved(const Curve& profile, int segments, bool loop = false, double crease_degrees = 35);

Mesh cylinder(double radius, double z0, double z1, int segments);
/// Frustum; a radius may be 0.
Mesh cone(double radius0, double radius1, double z0, double z1, int segments);
Mesh ball(const Vec3d& center, double radius, int segments);
/// Ring about z.
Mesh torus(double radius, double tube_radius, int segments, int tube_segments);

/// Crystal about z with flat faces: `sides` around, widest (`radius`) at height 0, a point at
/// `top` above and at `bottom` below; between them a belt of facets.
Mesh crystal(double radius, double top, double bottom, int sides);

/// Curve through the points (Catmull and Rom), `steps` pieces between neighbours.
std::vector<Vec3d> smooth_path(const std::vector<Vec3d>& points, int steps);
Curve smooth_curve(const Curve& points, int steps);
Curve circle(double radius, int segments);
/// Rectangle about the origin, counterclockwise.
Curve rectangle(double width, double height);

}  // namespace kaustik::scenes
