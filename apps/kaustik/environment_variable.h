#pragma once
#include <cstdlib>
#include <string>

namespace kaustik::app {

/// "" if there is none.
inline std::string environment_variable(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value ? value : "";
}

}  // namespace kaustik::app
