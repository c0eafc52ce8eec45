#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/fuzz/scene_grammar.h"

namespace kaustik::fuzz {

/// What became of a scene that did not end the program.
struct SceneResult {
  bool refused = false;               ///< by an Error, as scenes with bad values should be
  int renders = 0;                    ///< pictures made
  int renders_refused = 0;            ///< integrators that refused their parameters or the scene
  int dropped = 0;                    ///< pictures with samples that were not finite
  int with_lost_rays = 0;             ///< pictures with rays that left the range of floats
  std::vector<std::string> refusals;  ///< the errors
  /// What is wrong, each with the XML of the scene that shows it.
  std::vector<std::pair<std::string, std::string>> failures;
};

/// Builds the scene and renders it with every integrator, two passes each. `begins` is told what
/// comes next: an index into the scene's integrators, or their number for what is done without.
SceneResult check_scene(const GeneratedScene& scene, const std::function<void(size_t)>& begins);

}  // namespace kaustik::fuzz
