#pragma once
#include <string>
#include <utility>
#include <vector>

namespace kaustik {

struct LoadOptions {
  /// Name and value of each `-D name=value`: what stands for `$name` in attributes, before the
  /// file's own `<default>`.
  std::vector<std::pair<std::string, std::string>> definitions;
};

}  // namespace kaustik
