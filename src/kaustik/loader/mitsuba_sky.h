#pragma once
#include <memory>

#include "kaustik/loader/mitsuba_upgrade.h"

namespace kaustik::mitsuba {

/// Skies and suns of Mitsuba 0.6 have their zenith at +y, north at −z and east at +x, and names of
/// their own for scales: gives them the axes and names of today.
void upgrade_sky(Object& object, Version version);

/// Whether the light of a sun or a sky has no units of its own: Kaustik's are physical, Mitsuba's
/// are per nanometre.
bool lacks_units(const Object& object);

/// Whether a scene of that version means Mitsuba's units: its suns and skies are of before 2.0 and
/// since 3.7. In between it had none, so these scenes are Kaustik's.
bool means_units_of_mitsuba(Version version);

/// What lights a scene of before Mitsuba 2 that has no emitter: sun and sky, or before 0.4 the same
/// light from everywhere. Null: in later versions the scene is dark.
std::shared_ptr<Object> emitter_of_dark_scenes(Version version, const Place& place);

}  // namespace kaustik::mitsuba
