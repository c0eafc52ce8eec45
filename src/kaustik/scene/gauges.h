#pragma once
#include <vector>

#include "kaustik/scene/scene.h"

namespace kaustik {

/// The gauges of the scene's camera where they stand. One that lies on a surface, to a
/// hundred thousandth of the scene's size, is lifted a bit above it: light passes it on its way
/// there, and nothing shades it.
std::vector<PlacedGauge> place_gauges(const Scene& scene);

}  // namespace kaustik
