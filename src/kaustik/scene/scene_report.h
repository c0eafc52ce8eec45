#pragma once
#include <string>
#include <vector>

#include "kaustik/scene/scene.h"

namespace kaustik {

/// What is in a scene, for people.
struct SceneReport {
  std::vector<std::string> lines;
  /// What cannot work or is likely a mistake: no light, a light without power, albedo over 1, a
  /// camera inside a closed surface or at a wall, nothing in view.
  std::vector<std::string> warnings;
};
SceneReport describe_scene(const Scene& scene);

/// What is to be told of rays that RayTracer has refused.
std::string refused_rays_warning(uint64_t rays);

}  // namespace kaustik
