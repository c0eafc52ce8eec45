#pragma once
#include <string>
#include <vector>

#include "kaustik/base/parameters.h"

namespace kaustik {

/// The names of the rows that textures may stand for.
std::vector<std::string> texture_parameters(const TypeInfo& info);

/// The parameter that a texture `name` stands for; null if there is none. Where a texture is all
/// that can be given, it may have any name that no other parameter has, as in Mitsuba's bump maps.
const Parameter* texture_parameter(const TypeInfo& info, const std::string& name);

}  // namespace kaustik
