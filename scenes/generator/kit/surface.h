#pragma once
// Curved sheets over a grid: cloth, leaves, water, terrain.

#include "kit/mesh.h"

namespace kaustik::scenes {

using SurfaceFunction = std::function<Vec3d(double u, double v)>;  ///< u, v in [0, 1]

/// An open sheet of nu x nv cells, smooth; its outside is dS/du x dS/dv.
Mesh sheet(int nu, int nv, const SurfaceFunction& surface);
/// The sheet made `thickness` thick toward its inside, with rims: a closed solid.
Mesh thick_sheet(int nu, int nv, double thickness, const SurfaceFunction& surface,
                 double crease_degrees = 60);
/// Closed block with a top at heights `height(x, y)` over [low, high] and a flat base at `base`,
/// below all of them.
Mesh height_field(const Vec2d& low, const Vec2d& high, int nx, int ny, double base,
                  const std::function<double(double x, double y)>& height);

/// A leaf blade of `length` along +x with its stalk at the origin, folded along its middle and
/// drooping under its weight by the angle `droop` (radians) from stalk to tip; thin and closed.
Mesh leaf(double length, double width, double fold, double droop);

/// A hanging cloth of width x height in the xz plane, its top edge at z = 0 and y = 0: `folds`
/// folds of depth `depth` that grow toward the hem. Thin and closed.
Mesh curtain(double width, double height, int folds, double depth);

}  // namespace kaustik::scenes
