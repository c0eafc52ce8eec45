#pragma once
#include <string>

#include "kaustik/base/type_tables.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// The scene as XML of Mitsuba 3, to be stored in `folder` ("" for the working folder): the names
/// of files become relative to it, unless whole paths lead elsewhere. Reading it again gives the
/// same description, but for places; where an object without an id is shared by several others, it
/// gets one. `types`: which properties name files. Throws Error(input) for what XML cannot hold:
/// buffers, and texts with a '$'. `version`: of
/// the format, 2.0 or later; see in_terms_of_mitsuba3().
std::string mitsuba_xml(const Description& description, const TypeTables& types,
                        const std::string& folder, const std::string& version = "3.0.0");

}  // namespace kaustik
