#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// The buffer `data` of a volume `gridvolume` as a file of Mitsuba's format VOL, version 3, of
/// floats over the unit cube. A volume of that file is the same. Throws Error(input) where the
/// buffer is none of a volume.
std::vector<uint8_t> volume_as_vol(const Object& volume);

}  // namespace kaustik
