#include "man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "exit_codes.h"
#include "kaustik/base/version.h"

namespace kaustik::app {
namespace {

/// Text that roff takes for nothing else.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool begins_line = result.empty() || result.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

std::string heading(const std::string& name) { return ".SH " + name + "\n"; }

std::string title(const std::string& page, const std::string& sentence) {
  std::string upper = page;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](char c) { return char(std::toupper(static_cast<unsigned char>(c))); });
  std::string short_sentence = sentence;
  if (short_sentence.ends_with('.')) short_sentence.pop_back();
  return fmt::format(".TH {} 1 \"\" \"kaustik {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n",
                     roff(upper), KAUSTIK_VERSION, roff(page), roff(short_sentence));
}

/// Lines that begin with blanks are commands; all others are paragraphs.
std::string paragraphs(const std::string& text) {
  std::string result;
  bool in_commands = false;
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    const bool is_command = line.starts_with("  ");
    if (is_command && !in_commands) result += ".PP\n.RS\n.nf\n";
    if (!is_command && in_commands) result += ".fi\n.RE\n";
    in_commands = is_command;
    if (!is_command && !line.empty()) result += ".PP\n";
    if (!line.empty()) result += roff(is_command ? line.substr(2) : line) + "\n";
  }
  return in_commands ? result + ".fi\n.RE\n" : result;
}

/// "-o, --output FILE" with its sentence.
std::string option_rows(const std::vector<OptionText>& options) {
  std::string text;
  for (const OptionText& option : options) {
    std::string names;
    for (const std::string& name : option.names)
      names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
    const std::string value =
        option.may_have_value
            ? fmt::format("[=\\fI{}\\fR]",
                          roff(fmt::format("{}", fmt::join(option.values.names, "|"))))
        : option.value.empty()
            ? std::string()
            : fmt::format("{}\\fI{}\\fR", names.empty() ? "" : " ", roff(option.value));
    text += fmt::format(".TP\n{}{}\n{}{}\n", names, value, roff(option.sentence),
                        option.is_required && !option.names.empty() ? " (required)" : "");
  }
  return text;
}

std::string exit_status() {
  std::string text = heading("EXIT STATUS");
  for (const ExitCode& row : exit_codes())
    text += fmt::format(".TP\n.B {}\n{}\n", roff(row.code), roff(row.meaning));
  return text;
}

std::string synopsis(const CommandText& command) {
  std::string text =
      fmt::format("{}.B kaustik {}\n[\\fIOPTIONS\\fR]", heading("SYNOPSIS"), roff(command.name));
  for (const OptionText& argument : command.arguments) {
    const std::string name =
        fmt::format("\\fI{}\\fR{}", roff(argument.value), argument.may_repeat ? "..." : "");
    text += argument.is_required ? " " + name : " [" + name + "]";
  }
  return text + "\n";
}

}  // namespace

std::string man_page(const CommandText& command) {
  std::string text = title("kaustik-" + command.name, command.sentence) + synopsis(command);
  text += heading("DESCRIPTION") + paragraphs(command.sentence + "\n" + command.footer);
  if (!command.arguments.empty()) text += heading("ARGUMENTS") + option_rows(command.arguments);
  text += heading("OPTIONS") + option_rows(command.options);
  return text + exit_status() + heading("SEE ALSO") + ".BR kaustik (1)\n";
}

std::string man_page_of_program(const CLI::App& program) {
  const CommandText own = text_of(program);
  // The name stands before it already.
  const std::string name = "Kaustik: ";
  std::string text = title(
      "kaustik", own.sentence.starts_with(name) ? own.sentence.substr(name.size()) : own.sentence);
  text += heading("SYNOPSIS") + ".B kaustik\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  // The table of exit codes has a section of its own.
  std::string footer = own.footer;
  footer = footer.substr(0, footer.find(exit_code_text()));
  text += heading("DESCRIPTION") + paragraphs(footer) + heading("COMMANDS");
  std::string pages, group;
  for (const CommandText& command : command_texts(program)) {
    if (command.group != group) text += fmt::format(".SS {}\n", group = command.group);
    text += fmt::format(".TP\n.B {}\n{}\n", roff(command.name), roff(command.sentence));
    pages += fmt::format("{}.BR kaustik\\-{} (1)", pages.empty() ? "" : ",\n", command.name);
  }
  text += heading("OPTIONS") + option_rows(own.options);
  return text + exit_status() + heading("SEE ALSO") + pages + "\n";
}

}  // namespace kaustik::app
