#pragma once
#include <string>

namespace kaustik {

/// With small letters for the capital ones of English; others stay.
inline std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

}  // namespace kaustik
