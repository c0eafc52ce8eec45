#include "first_steps.h"

#include <fmt/format.h>

#include "command_tree.h"
#include "kaustik/base/version.h"
#include "program_files.h"

namespace kaustik::app {
namespace {

/// What stands before the first comma or colon, without brackets.
std::string beginning_of(const std::string& sentence) {
  std::string text;
  int depth = 0;
  for (const char c : sentence) {
    if (depth == 0 && (c == ',' || c == ':' || c == '.')) break;
    depth += c == '(' ? 1 : 0;
    if (depth == 0 && !(c == ' ' && text.ends_with(' '))) text += c;
    depth -= c == ')' ? 1 : 0;
  }
  return text;
}

}  // namespace

std::string first_steps(const CLI::App& program) {
  std::string text = fmt::format(
      "Kaustik {} renders light that glass, metal and water focus.\n\n"
      "Start with these:\n"
      "  kaustik example caustic                                writes a scene\n"
      "  kaustik render caustic.xml --time 20s -o caustic.png   renders it\n"
      "  kaustik view caustic.xml                               shows it in a browser\n\n",
      KAUSTIK_VERSION);
  std::string group;
  for (const CommandText& command : command_texts(program)) {
    text += fmt::format("{:9}{:12}{}\n", command.group == group ? "" : command.group, command.name,
                        beginning_of(command.sentence));
    group = command.group;
  }
  const std::string manual = shown_path(manual_page());
  text += fmt::format(
      "\n"
      "kaustik COMMAND --help lists its options; kaustik help lists scene objects.\n"
      "The manual: man kaustik{}",
      manual.empty() ? "" : ", " + manual);
  return text;
}

}  // namespace kaustik::app
