#pragma once
#include "kaustik/loader/mitsuba_upgrade.h"

namespace kaustik::mitsuba {

/// Skies and suns of Mitsuba 0.6 have their zenith at +y, north at −z and east at +x, and names of
/// their own for scales: gives them the axes and names of today.
void upgrade_sky(Object& object, Version version);

}  // namespace kaustik::mitsuba
