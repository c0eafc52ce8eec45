#pragma once
#include <functional>
#include <string>

namespace kaustik {

/// Where sentences for the user go; an empty function drops them.
struct Messages {
  std::function<void(const std::string&)> note;     ///< what the user may want to know
  std::function<void(const std::string&)> warning;  ///< what is odd, or went wrong by half

  void tell(const std::string& sentence) const {
    if (note) note(sentence);
  }
  void warn(const std::string& sentence) const {
    if (warning) warning(sentence);
  }
};

}  // namespace kaustik
