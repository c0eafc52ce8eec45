#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <memory>

#include "command_tree.h"
#include "commands.h"
#include "kaustik/base/error.h"
#include "shell_completions.h"

namespace kaustik::app {
namespace {

struct Shell {
  const char* name;
  std::string (*completions)(const std::vector<CommandText>& commands);
};
constexpr Shell shells[] = {
    {"bash", bash_completions}, {"zsh", zsh_completions}, {"fish", fish_completions}};

std::vector<std::string> shell_names() {
  std::vector<std::string> names;
  for (const Shell& shell : shells) names.emplace_back(shell.name);
  return names;
}

void print_completions(const CLI::App& program, const std::string& name) {
  for (const Shell& shell : shells)
    if (name == shell.name) return fmt::print("{}", shell.completions(command_texts(program)));
  throw Error(ErrorKind::input, fmt::format("no completions for the shell '{}'", name),
              suggest(name, shell_names()));
}

}  // namespace

void add_completion(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "completion", "Print completions of commands and options for a shell.");
  command->footer(
      "Packages install them. To install them by hand, write eval \"$(kaustik completion bash)\" "
      "into ~/.bashrc. For zsh, write the same with zsh into ~/.zshrc, after compinit. For fish, "
      "write kaustik completion fish | source into config.fish.");
  auto name = std::make_shared<std::string>();
  takes_words(command->add_option("shell", *name, "bash, zsh or fish")->required(), shell_names());
  command->callback([name, &program] { print_completions(program, *name); });
}

}  // namespace kaustik::app
