#pragma once
#include <string>

namespace kaustik::app {

/// A word as a shell has to see it: in single quotes, unless it means itself.
std::string quoted_for_shell(const std::string& word);

}  // namespace kaustik::app
