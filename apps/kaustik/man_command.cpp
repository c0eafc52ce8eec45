#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "command_tree.h"
#include "commands.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "man_page.h"

namespace kaustik::app {
namespace {

struct ManOptions {
  std::string command, folder;
};

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

void write_page(const std::string& folder, const std::string& name, const std::string& text) {
  write_file_atomically((std::filesystem::path(folder) / name).string(),
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

void write_all(const CLI::App& program, const std::string& folder) {
  write_page(folder, "kaustik.1", man_page_of_program(program));
  for (const CommandText& command : command_texts(program))
    write_page(folder, fmt::format("kaustik-{}.1", command.name), man_page(command));
}

void print_page(const CLI::App& program, const std::string& name) {
  if (name.empty()) return fmt::print("{}", man_page_of_program(program));
  for (const CommandText& command : command_texts(program))
    if (command.name == name) return fmt::print("{}", man_page(command));
  throw Error(ErrorKind::input, fmt::format("there is no command '{}'", name),
              suggest(name, command_names(program)));
}

}  // namespace

void add_man(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("man", "Print the man page of a command, or of the program.");
  command->footer(
      "Packages install the pages; man kaustik-render shows one. To read a printed page, pipe it "
      "to man -l -.");
  auto o = std::make_shared<ManOptions>();
  auto* name = command->add_option("command", o->command, "Command [the program itself]");
  takes_words(name, command_names(program), "COMMAND");
  takes(
      command->add_option("--folder", o->folder, "Write all pages to this folder")->excludes(name),
      "FOLDER");
  command->callback([o, &program] {
    if (o->folder.empty())
      print_page(program, o->command);
    else
      write_all(program, o->folder);
  });
}

}  // namespace kaustik::app
