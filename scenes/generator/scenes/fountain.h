#pragma once
#include "kit/scene_folder.h"

namespace kaustik::scenes {

/// Adds a fountain about the origin with moving water: streams from its top into a bowl, from the
/// bowl's rim into the basin, drops, and the rings that they make. Needs the materials
/// "marble_pale", "marble_green", "bronze" and "water".
void add_fountain(SceneFolder& scene, uint64_t seed);

}  // namespace kaustik::scenes
