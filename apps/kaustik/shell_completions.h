#pragma once
#include <string>
#include <vector>

#include "command_tree.h"

namespace kaustik::app {

// Scripts that complete commands, options and their values, each for its shell.
std::string bash_completions(const std::vector<CommandText>& commands);
std::string zsh_completions(const std::vector<CommandText>& commands);
std::string fish_completions(const std::vector<CommandText>& commands);

}  // namespace kaustik::app
