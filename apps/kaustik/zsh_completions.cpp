#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shell_completions.h"

namespace kaustik::app {
namespace {

/// Within single quotes, and where a colon or a bracket would end it.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'')
      result += "'\\''";
    else if (c == ':' || c == '[' || c == ']' || c == '\\')
      result += {'\\', c};
    else if (c == '\n')
      result += ' ';
    else
      result += c;
  }
  return result;
}

/// "*.(exr|png)". Parentheses around one alone would be glob qualifiers.
std::string zsh_pattern(const std::vector<std::string>& extensions) {
  const std::string list = fmt::format("{}", fmt::join(extensions, "|"));
  return extensions.size() == 1 ? "*." + list : "*.(" + list + ")";
}

std::string zsh_action(const OptionValues& values) {
  switch (values.kind) {
    case OptionValues::Kind::files:
      return values.names.empty() ? "_files"
                                  : fmt::format("_files -g \"{}\"", zsh_pattern(values.names));
    case OptionValues::Kind::words:
      return fmt::format("({})", fmt::join(values.names, " "));
    default:
      return " ";
  }
}

/// What _arguments takes for an option, in one of its spellings.
std::string zsh_option(const OptionText& option, const std::string& name) {
  const std::string others =
      option.may_repeat ? "*" : fmt::format("({})", fmt::join(option.names, " "));
  const std::string told = "[" + zsh_text(option.sentence) + "]";
  const std::string value = zsh_text(option.value.empty() ? "value" : option.value);
  if (option.may_have_value)
    return fmt::format("'{}{}=-{}::{}:{}'", others, name, told, value, zsh_action(option.values));
  if (!option.takes_value) return fmt::format("'{}{}{}'", others, name, told);
  const char* const joint = name.starts_with("--") ? "=" : "+";
  return fmt::format("'{}{}{}{}:{}:{}'", others, name, joint, told, value,
                     zsh_action(option.values));
}

std::string zsh_argument(const OptionText& argument) {
  return fmt::format("'{}:{}:{}'",
                     argument.may_repeat    ? "*"
                     : argument.is_required ? ""
                                            : ":",
                     zsh_text(argument.value), zsh_action(argument.values));
}

}  // namespace

std::string zsh_completions(const std::vector<CommandText>& commands) {
  std::string names, cases;
  for (const CommandText& command : commands) {
    names += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.sentence));
    cases += fmt::format("    {})\n      _arguments -S", command.name);
    for (const OptionText& option : command.options)
      for (const std::string& name : option.names)
        cases += " \\\n        " + zsh_option(option, name);
    for (const OptionText& argument : command.arguments)
      cases += " \\\n        " + zsh_argument(argument);
    cases += "\n      ;;\n";
  }
  return fmt::format(
      R"(#compdef kaustik
# Completions of kaustik for zsh; printed by: kaustik completion zsh

_kaustik() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe -t commands 'command of kaustik' commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT -= 1 ))
  case $command in
{}  esac
}}

if [[ $funcstack[1] == _kaustik ]]; then
  _kaustik "$@"
else
  compdef _kaustik kaustik
fi
)",
      names, cases);
}

}  // namespace kaustik::app
