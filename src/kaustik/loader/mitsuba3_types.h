#pragma once
#include <string>
#include <vector>

#include "kaustik/base/parameters.h"

namespace kaustik {

/// Whether Mitsuba 3.7 has the type; of families that hold no types here it has all.
bool mitsuba3_has_type(const std::string& family, const std::string& type);

/// Parameters that make a difference in Kaustik and that Mitsuba 3 lacks; "" stands for all types.
/// With `values` it has the parameter, but not these values of it.
struct LackingInMitsuba3 {
  std::string family, type, name;
  std::vector<std::string> values = {};
};
/// The row about a property; null: Mitsuba 3 has it, or no row tells.
const LackingInMitsuba3* lacking_in_mitsuba3(const std::string& family, const std::string& type,
                                             const Property& property);

/// Whether a parameter that changes no light in Kaustik has a meaning in Mitsuba 3, so that it is
/// not to be left out.
bool is_known_to_mitsuba3(const std::string& parameter);
/// Whether a parameter that Kaustik knows changes no light, and is unknown to Mitsuba 3.
bool may_be_left_out(const std::string& family, const std::string& parameter);

}  // namespace kaustik
