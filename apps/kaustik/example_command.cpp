#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "commands.h"
#include "examples.h"
#include "file_roles.h"
#include "kaustik/base/file.h"
#include "option_values.h"
#include "scene_options.h"
#include "screen.h"
#include "shell_words.h"

namespace kaustik::app {
namespace {

struct ExampleOptions {
  std::string name, output;
  bool force = false;
};

void list_examples() {
  for (const Example& example : examples())
    fmt::print("  {:8} {}\n", name_of(example), sentence_of(example));
  fmt::print("\nkaustik example NAME writes one of them to NAME.xml.\n");
}

const Example& find_example(const std::string& name) {
  const auto found = std::find_if(examples().begin(), examples().end(),
                                  [&](const Example& example) { return name_of(example) == name; });
  if (found == examples().end())
    throw Error(ErrorKind::input, fmt::format("there is no example '{}'", name),
                suggest(name, example_names()));
  return *found;
}

void write_example(const ExampleOptions& options) {
  const Example& example = find_example(options.name);
  const std::string output = options.output.empty() ? std::string(example.file) : options.output;
  check_scene_name(output);
  FileRoles roles;
  roles.writes(output, any_file, options.force ? Replacing::anything : Replacing::nothing,
               "choose another name: -o FILE");
  write_text_atomically(output, example.text);
  say("wrote {}: {}", output, sentence_of(example));
  say("render it:  kaustik render {} --time 20s -o {}.png", quoted_for_shell(output),
      name_of(example));
  say("or live:    kaustik view {}", quoted_for_shell(output));
}

}  // namespace

std::string name_of(const Example& example) {
  return std::string(example.file.substr(0, example.file.find('.')));
}

std::string sentence_of(const Example& example) {
  const std::string_view start = "<!-- ";
  const std::string_view comment = example.text.substr(example.text.find(start) + start.size());
  return std::string(comment.substr(0, comment.find('.') + 1));
}

std::vector<std::string> example_names() {
  std::vector<std::string> names;
  for (const Example& example : examples()) names.push_back(name_of(example));
  return names;
}

void add_example(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("example", "Write a small scene to start with, or list all.");
  command->footer(
      "The scenes are complete. Their comments say what you can change.\n"
      "  kaustik example box\n"
      "  kaustik render box.xml -D lamps=bulbs --time 20s -o box.png");
  auto o = std::make_shared<ExampleOptions>();
  auto* name = takes_words(command->add_option("name", o->name, "Scene to write [lists all]"),
                           example_names(), "NAME");
  takes_files(
      command->add_option("-o,--output", o->output, "Scene file to write [NAME.xml]")->needs(name),
      {"xml"});
  command->add_flag("--force", o->force, "Replace an existing file")->needs(name);
  command->callback([o] {
    if (o->name.empty())
      list_examples();
    else
      write_example(*o);
  });
}

}  // namespace kaustik::app
