#pragma once
#include <string>

namespace kaustik::app {

/// The file of a scene. Of a path "scenes/…" that leads nowhere from the working folder it is the
/// one that lies in the program's installation, if there is one; of all others it is the path
/// itself.
std::string scene_file(const std::string& path);

}  // namespace kaustik::app
