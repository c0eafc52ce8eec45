#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// The samples of a volume `gridvolume` that has a buffer, as a file of Mitsuba's format VOL, of
/// floats: the same volume with this file instead of `data`. Throws Error(input) for a buffer that
/// build_scene() would refuse.
std::vector<uint8_t> volume_as_vol(const Object& volume);

}  // namespace kaustik
