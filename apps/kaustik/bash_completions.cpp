#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shell_completions.h"

namespace kaustik::app {
namespace {

constexpr const char* bash_start =
    R"(# Completions of kaustik for bash; printed by: kaustik completion bash

# Files whose names end in one of the arguments, and folders; without arguments all files.
_kaustik_files() {
  local extension IFS=$'\n'
  compopt -o filenames 2>/dev/null
  if (($# == 0)); then
    COMPREPLY=($(compgen -f -- "$current"))
    return
  fi
  COMPREPLY=($(compgen -d -- "$current"))
  for extension; do COMPREPLY+=($(compgen -f -X "!*.$extension" -- "$current")); done
}

_kaustik_words() { COMPREPLY=($(compgen -W "$*" -- "$current")); }

_kaustik() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} joined=
  COMPREPLY=()
  # bash takes "=" for a word.
  if [[ $current == = ]]; then
    current= joined==
  elif [[ $previous == = && $COMP_CWORD -gt 2 ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]} joined==
  fi
)";

/// What completes the value.
std::string bash_action(const OptionValues& values) {
  switch (values.kind) {
    case OptionValues::Kind::files:
      return fmt::format("_kaustik_files {}", fmt::join(values.names, " "));
    case OptionValues::Kind::words:
      return fmt::format("_kaustik_words {}", fmt::join(values.names, " "));
    default:
      return ":";
  }
}

/// "render:-o* | render:--output*": with and without "=".
std::string bash_patterns(const std::string& command, const OptionText& option) {
  std::string text;
  for (const std::string& name : option.names)
    text += fmt::format("{}{}:{}{}", text.empty() ? "" : " | ", command, name,
                        option.takes_value ? " | " + command + ":" + name + "=" : "=");
  return text;
}

}  // namespace

std::string bash_completions(const std::vector<CommandText>& commands) {
  std::string names, values, options, arguments;
  for (const CommandText& command : commands) {
    names += " " + command.name;
    std::string option_names;
    for (const OptionText& option : command.options) {
      option_names += fmt::format(" {}", fmt::join(option.names, " "));
      if (option.takes_value || option.may_have_value)
        values += fmt::format("    {}) {}; return ;;\n", bash_patterns(command.name, option),
                              bash_action(option.values));
    }
    options += fmt::format("      {}) _kaustik_words{} ;;\n", command.name, option_names);
    // Commands that take more than one argument take more of a kind.
    if (!command.arguments.empty())
      arguments += fmt::format("    {}) {} ;;\n", command.name,
                               bash_action(command.arguments.back().values));
  }
  std::string text = bash_start;
  text += fmt::format(
      "  if ((COMP_CWORD == 1)); then\n    _kaustik_words{} --help --version\n    return\n  fi\n",
      names);
  text += "  case $command:$previous$joined in\n" + values + "  esac\n";
  text += "  if [[ $current == -* ]]; then\n    case $command in\n" + options +
          "    esac\n    return\n  fi\n";
  text += "  case $command in\n" + arguments + "  esac\n}\ncomplete -F _kaustik kaustik\n";
  return text;
}

}  // namespace kaustik::app
