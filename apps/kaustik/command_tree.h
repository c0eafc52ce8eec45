#pragma once
// What the commands and their options are, as they were declared: for man pages and completions.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "option_values.h"

namespace kaustik::app {

struct OptionText {
  std::vector<std::string> names;  ///< "-o", "--output"; none: it is told by its place alone
  std::string value;               ///< what --help calls its value or argument; "": it takes none
  std::string sentence;
  OptionValues values;
  bool takes_value = false;     ///< the word that follows
  bool may_have_value = false;  ///< only as --option=VALUE
  bool may_repeat = false, is_required = false;
};

struct CommandText {
  std::string name;   ///< "render"
  std::string group;  ///< "Pictures"
  std::string sentence, footer;
  std::vector<OptionText> arguments, options;
};

CommandText text_of(const CLI::App& command);
/// Of all commands of the program, in their order.
std::vector<CommandText> command_texts(const CLI::App& program);

}  // namespace kaustik::app
