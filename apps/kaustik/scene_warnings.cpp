#include "scene_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace kaustik::app {
namespace {

/// Steps between neighbouring floats at the scene's farthest coordinate, over the scene's size,
/// from which on they are seen: a fifth of a pixel in a picture of 2000.
constexpr float coarse_step = 1e-4f;

}  // namespace

std::string coordinates_warning(const Scene& scene) {
  const Bounds3f box = scene.tracer().bounds();
  const float farthest = std::max(max_abs(box.min), max_abs(box.max)), size = length(box.size());
  const float step = farthest * std::numeric_limits<float>::epsilon();
  if (step <= coarse_step * size) return {};
  return fmt::format(
      "the scene is {:.2g} m wide, but {:.2g} m from the origin coordinates are rounded to {:.2g} "
      "m: move shapes, lights and camera to the origin",
      size, farthest, step);
}

std::vector<std::string> scene_warnings(const Scene& scene) {
  std::vector<std::string> warnings = scene.warnings();
  if (const std::string coarse = coordinates_warning(scene); !coarse.empty())
    warnings.push_back(coarse);
  return warnings;
}

std::string darkness_warning(const Scene& scene) {
  if (scene.lights().empty())
    return "the scene has no light: the picture will be black; add an <emitter> to it";
  const bool may_shine = std::ranges::any_of(scene.lights(), [](const auto& light) {
    return light->is_only_seen() || light->power().sum() > 0;
  });
  if (may_shine) return {};
  return "no light of the scene has power: the picture will be black; give an <emitter> more than "
         "0";
}

}  // namespace kaustik::app
