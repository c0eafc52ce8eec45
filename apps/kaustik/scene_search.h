#pragma once
#include <string>

namespace kaustik::app {

/// Throws Error(input) where no scene can be read: nothing is there, a folder, or a file of another
/// kind. The remedy tells what is there: scenes of similar names nearby, in the folder, among the
/// examples and those that ship, or what to do with a file of that kind.
void check_scene_file(const std::string& path);

/// The command line that the file was likely meant for, by its name: "kaustik resume a.kpt"; "" if
/// none is known.
std::string command_line_for(const std::string& file);

}  // namespace kaustik::app
