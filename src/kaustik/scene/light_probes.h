#pragma once
#include "kaustik/scene/scene.h"

namespace kaustik {

/// Learns which lights are seen from where: at the surfaces that paths from the camera meet, bounce
/// by bounce, every light is sampled once. The random numbers are always the same, so a scene has
/// one answer. The rays are not shown to the scene's observer. Nothing is learned where the lights
/// are too few or too many to choose among (LightSelector::can_learn), or where null boundaries
/// lie in the way of shadow rays.
LightVisibility probe_lights(const Scene& scene);

}  // namespace kaustik
