#pragma once
#include <filesystem>
#include <string>

namespace kaustik::app {

// What lies beside the program: it is looked for from where the program itself is, in an
// installation or in the source tree that it was built in.

/// The scenes that ship; "" if they are not there.
std::filesystem::path scenes_folder();
/// The file of a scene. A path "scenes/…" that leads nowhere from the working folder names a scene
/// that ships, if there is one; every other path stays as it is.
std::string scene_file(const std::string& path);
/// The first page of the manual; "" if it is not there.
std::filesystem::path manual_page();

/// The path as people would write it: from the working folder, if it lies there.
std::string shown_path(const std::filesystem::path& path);

}  // namespace kaustik::app
