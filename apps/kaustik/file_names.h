#pragma once
#include <string>

namespace kaustik::app {

/// Of a file's name, in lower case and without the dot: "exr"; "": it has none.
std::string extension_of(const std::string& file);

}  // namespace kaustik::app
