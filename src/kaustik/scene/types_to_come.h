#pragma once
#include <optional>
#include <string>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Of a type that Mitsuba has and Kaustik has not yet: what will do instead, "" if there is nothing
/// to say. None for all other types, those that nobody has among them.
std::optional<std::string> remedy_for_type_to_come(const Object& object);

}  // namespace kaustik
