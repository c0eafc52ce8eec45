#pragma once
#include <string>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/pbrt/parameters.h"

namespace kaustik::pbrt {

// Files of pbrt-v3 in terms of v4. Names of v4 stay as they are; what changes in looks is told.

/// The type that the material has in v4; its parameters are renamed.
std::string upgraded_material(const std::string& type, ParameterList& list,
                              const std::string& object, Deviations& deviations);
/// The type of a light, and its `scale` as a number.
std::string upgraded_light(const std::string& type, ParameterList& list, const std::string& object,
                           Deviations& deviations);
/// The type of a medium.
std::string upgraded_medium(const std::string& type);

}  // namespace kaustik::pbrt
