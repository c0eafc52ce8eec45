#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shell_completions.h"

namespace kaustik::app {
namespace {

/// In single quotes.
std::string fish_text(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result + "'";
}

std::string fish_values(const OptionValues& values) {
  switch (values.kind) {
    case OptionValues::Kind::files: {
      if (values.names.empty()) return " -F";
      std::string suffixes;
      for (const std::string& name : values.names)
        suffixes += fmt::format("{}__fish_complete_suffix .{}", suffixes.empty() ? "" : "; ", name);
      return fmt::format(" -k -a '({})'", suffixes);
    }
    case OptionValues::Kind::words:
      return " -a " + fish_text(fmt::format("{}", fmt::join(values.names, " ")));
    default:
      return {};
  }
}

std::string fish_option(const OptionText& option) {
  std::string text;
  for (const std::string& name : option.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (option.takes_value) {
    // -x: nothing but what is given here; -F brings back all files.
    text += option.values.kind == OptionValues::Kind::files && option.values.names.empty() ? " -r"
                                                                                           : " -x";
    text += fish_values(option.values);
  }
  return text + " -d " + fish_text(option.sentence);
}

}  // namespace

std::string fish_completions(const std::vector<CommandText>& commands) {
  std::string text =
      "# Completions of kaustik for fish; printed by: kaustik completion fish\n"
      "complete -c kaustik -f\n"
      "complete -c kaustik -n __fish_use_subcommand -l help -s h -d 'Print the commands'\n"
      "complete -c kaustik -n __fish_use_subcommand -l version -d 'Print the version'\n";
  for (const CommandText& command : commands) {
    text += fmt::format("complete -c kaustik -n __fish_use_subcommand -a {} -d {}\n", command.name,
                        fish_text(command.sentence));
    const std::string within =
        fmt::format("complete -c kaustik -n '__fish_seen_subcommand_from {}'", command.name);
    for (const OptionText& option : command.options) text += within + fish_option(option) + "\n";
    for (const OptionText& argument : command.arguments)
      if (argument.values.kind != OptionValues::Kind::other)
        text += within + fish_values(argument.values) + "\n";
  }
  return text;
}

}  // namespace kaustik::app
