#pragma once
#include "kaustik/loader/mitsuba_upgrade.h"

namespace kaustik::mitsuba {

/// Homogeneous media of Mitsuba 0.6: its materials are a hundred times as dense as their table says
/// (per millimetre), and what coefficients a medium does not give are those of "skin1".
void upgrade_medium(Object& object, Version version);

}  // namespace kaustik::mitsuba
