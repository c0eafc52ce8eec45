#pragma once
// What make_scenes can make: one source file and one row of the table in registry.cpp each.

#include <span>

#include "kit/scene_folder.h"

namespace kaustik::scenes {

struct SceneOptions {
  uint64_t seed = 1;   ///< of everything random
  int maze_size = 12;  ///< cells along each side of the maze
};

struct SceneMaker {
  std::string name;
  std::string sentence;
  SceneFolder (*make)(const SceneOptions&);
};

std::span<const SceneMaker> scene_makers();

SceneFolder make_point_spotlight(const SceneOptions& options);
SceneFolder make_museum(const SceneOptions& options);
SceneFolder make_gallery_1(const SceneOptions& options);
SceneFolder make_gallery_2(const SceneOptions& options);
SceneFolder make_maze(const SceneOptions& options);
SceneFolder make_pool_above(const SceneOptions& options);
SceneFolder make_pool_below(const SceneOptions& options);
SceneFolder make_atrium(const SceneOptions& options);
SceneFolder make_still_life(const SceneOptions& options);

}  // namespace kaustik::scenes
