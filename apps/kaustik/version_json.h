#pragma once
#include <string>

namespace kaustik::app {

/// The version, what the program was built with and what it runs on, as a line of JSON.
std::string version_json();

}  // namespace kaustik::app
