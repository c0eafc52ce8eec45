#include "scenes/scenes.h"

namespace kaustik::scenes {

std::span<const SceneMaker> scene_makers() {
  static const std::vector<SceneMaker> makers = {};
  return makers;
}

}  // namespace kaustik::scenes
