#pragma once
// The clouds of pbrt: a density by formula.

#include <array>
#include <cstddef>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik::pbrt {

/// The parameters of a medium "cloud".
struct CloudShape {
  double density = 1, wispiness = 1, frequency = 5;
};

/// Noise with gradients toward the edges of a cube, by a table with a period of 256 (Perlin,
/// "Improving Noise", SIGGRAPH 2002). Of the 16 gradients, four of the twelve count twice; which
/// ones is as in pbrt-v4. 0 where all coordinates are whole.
double cloud_noise(const Vec3d& p);

/// From 0 to 1, at a point of the medium's own space, whose y is up: pbrt-v4's CloudMedium.
double cloud_density(const CloudShape& cloud, const Vec3d& p);

/// The same at the middles of the cells of a box; x runs fastest.
std::vector<float> cloud_densities(const CloudShape& cloud, const Vec3d& low, const Vec3d& extent,
                                   const std::array<size_t, 3>& cells);

}  // namespace kaustik::pbrt
