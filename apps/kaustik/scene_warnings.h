#pragma once
#include <string>
#include <vector>

#include "kaustik/scene/scene.h"

namespace kaustik::app {

/// What to do where floats are too coarse for the scene's coordinates; "" if they are not.
std::string coordinates_warning(const Scene& scene);

/// That, and what the builder of the scene found odd.
std::vector<std::string> scene_warnings(const Scene& scene);

/// Why the picture will be black; "" if there is light.
std::string darkness_warning(const Scene& scene);

}  // namespace kaustik::app
