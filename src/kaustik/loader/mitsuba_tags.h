#pragma once
// The elements of the format.

#include <string>
#include <string_view>
#include <vector>

namespace kaustik::mitsuba {

/// Objects; the tag is the family.
const std::vector<std::string>& object_tags();
/// Properties that are one value.
const std::vector<std::string>& property_tags();
/// What may stand in <transform>.
const std::vector<std::string>& transform_tags();
/// Whatever may stand in an object.
const std::vector<std::string>& part_tags();

/// Names of properties that are files, relative to the one that names them.
const std::vector<std::string>& file_property_names();

bool is_in(const std::vector<std::string>& names, std::string_view name);

}  // namespace kaustik::mitsuba
