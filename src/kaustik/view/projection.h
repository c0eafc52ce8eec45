#pragma once
#include <array>
#include <optional>

#include "kaustik/base/vec.h"

namespace kaustik {
class Camera;
}

namespace kaustik::view {

/// How a camera of straight lines sees points: (x·w, y·w, w) is the matrix, 3 rows of 4 numbers,
/// times (X, Y, Z, 1). X, Y, Z in the world, m; x, y raster coordinates in the crop window; w is
/// positive before the camera, and 1 everywhere for one that sees along parallel lines.
using Projection = std::array<double, 12>;

/// By the middle of the lens. `size`: pixels of the crop window. None: no matrix tells how the
/// camera sees.
std::optional<Projection> projection_of(const Camera& camera, const Vec2i& size);

}  // namespace kaustik::view
