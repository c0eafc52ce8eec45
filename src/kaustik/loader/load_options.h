#pragma once
#include <string>
#include <utility>
#include <vector>

namespace kaustik {

struct LoadOptions {
  /// Names and values: what stands for `$name` in attributes, before the file's own `<default>`.
  std::vector<std::pair<std::string, std::string>> definitions;
  /// What nobody knows is an error: elements here, parameters where the scene is built. Otherwise
  /// it is left out and told, unless it looks like a slip of the pen.
  bool is_strict = false;
  /// For messages, where definitions come from, and what is written before "name=value" to give one
  /// there: "command line", "-D ".
  std::string definitions_origin = "definitions", definition_prefix = {};
};

}  // namespace kaustik
