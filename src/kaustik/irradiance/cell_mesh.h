#pragma once
#include <vector>

#include "kaustik/irradiance/hemisphere.h"

namespace kaustik {

/// What is known of one cell of a hemisphere after sampling.
struct HemisphereCell {
  Spectrum radiance;           ///< mean
  float inverse_distance = 0;  ///< mean, 1/m
  bool open = false;           ///< some direction in it lies above the geometric surface
  Vec3f direction{0, 0, 1};    ///< unit, local: where one of its samples went …
  float distance = infinity;   ///< … and how far, m
};

/// Second derivatives of irradiance by the position of the point, in the tangent plane (the frame's
/// x and y): Schwarzhaupt, Jensen and Jarosz 2012. What the samples hit is joined to triangles, one
/// sample of each cell being a vertex; a triangle has the radiance of its vertices, the farther
/// ones counting more, since what an edge of something near hides or shows as the point moves is
/// what lies behind it. The irradiance of such a mesh is a sum over its edges (Lambert's formula),
/// of which the derivatives are known in closed form. What is infinitely far away stands still.
TangentHessian translation_hessian(const HemisphereGrid& grid,
                                   const std::vector<HemisphereCell>& cells);

}  // namespace kaustik
