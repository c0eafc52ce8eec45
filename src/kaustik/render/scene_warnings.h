#pragma once
#include <string>
#include <vector>

#include "kaustik/scene/scene.h"

namespace kaustik {

/// What to do where floats are too coarse for the scene's coordinates; "" if they are not.
std::string coordinates_warning(const Scene& scene);

/// Where an irradiancemeter can't see lamps that no ray meets; "" elsewhere.
std::string missed_lamps_warning(const Scene& scene);

/// These, and what the builder of the scene found odd.
std::vector<std::string> scene_warnings(const Scene& scene);

/// Of points that the camera sees some may be lit only through glass or a mask by a lamp that no
/// path can meet (point, spot, directional): methods that follow paths from the camera alone never
/// find that light. Which to use instead; "" if there are none, or `integrator` finds it.
std::string hidden_lamps_warning(const Scene& scene, const std::string& integrator);

/// Why the picture will be black; "" if there is light.
std::string darkness_warning(const Scene& scene);

}  // namespace kaustik
