#pragma once
#include <string>

namespace kaustik::app {

/// "1 h 02 min", "3 min 04 s", "12 s".
std::string duration_text(double seconds);
/// "12.3 M", "4.5 k".
std::string count_text(double count);

}  // namespace kaustik::app
