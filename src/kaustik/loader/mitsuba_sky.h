#pragma once
#include <memory>

#include "kaustik/loader/mitsuba_upgrade.h"

namespace kaustik::mitsuba {

/// Skies and suns of Mitsuba 0.6 have their zenith at +y, north at −z and east at +x, and names of
/// their own for scales: gives them the axes and names of today.
void upgrade_sky(Object& object, Version version);

/// What lights a scene of before Mitsuba 2 that has no emitter: sun and sky, or before 0.4 the same
/// light from everywhere. Null: in later versions the scene is dark.
std::shared_ptr<Object> emitter_of_dark_scenes(Version version, const Place& place);

}  // namespace kaustik::mitsuba
