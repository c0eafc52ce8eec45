#pragma once
#include <string>

namespace kaustik::app {

/// Whether the file is a picture rather than a scene, by its name.
bool is_picture_name(const std::string& path);

/// Prints size, layers with their channels, and metadata of a picture file. Throws Error.
void print_picture(const std::string& path);

}  // namespace kaustik::app
