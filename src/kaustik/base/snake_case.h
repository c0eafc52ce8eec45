#pragma once
#include <cctype>
#include <string>

namespace kaustik {

/// toWorld becomes to_world, intIOR int_ior: a name of Mitsuba 0.6 as later versions write it. Of
/// others nothing changes.
inline std::string snake_case_from_camel_case(const std::string& name) {
  const auto is_lower = [&](size_t i) {
    return std::islower(static_cast<unsigned char>(name[i])) != 0;
  };
  const auto is_upper = [&](size_t i) {
    return std::isupper(static_cast<unsigned char>(name[i])) != 0;
  };
  const auto lower = [&](size_t i) {
    return char(std::tolower(static_cast<unsigned char>(name[i])));
  };
  std::string result;
  for (size_t i = 0; i < name.size(); ++i) {
    const bool starts_word = i > 0 && is_lower(i - 1) && is_upper(i);
    if (!starts_word) {
      result += name[i];
      continue;
    }
    result += '_';
    result += lower(i);
    while (i + 1 < name.size() && is_upper(i + 1)) result += lower(++i);
  }
  return result;
}

}  // namespace kaustik
