#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace kaustik::app {

/// A small scene to start with, as it is embedded in the program.
struct Example {
  std::string_view file;  ///< "caustic.xml"
  std::string_view text;
};
/// In the order of their names. Made by cmake/embed_assets.cmake from scenes/examples.
const std::vector<Example>& examples();

/// "caustic".
std::string name_of(const Example& example);
/// What it shows: the first sentence of the scene's first comment.
std::string sentence_of(const Example& example);
std::vector<std::string> example_names();

}  // namespace kaustik::app
