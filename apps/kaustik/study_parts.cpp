#include "study_parts.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "commands.h"
#include "kaustik/base/error.h"

namespace kaustik::app {
namespace {

/// Options that name files or parts: each variant has its own.
constexpr const char* own_options[] = {"output",          "progress-file", "checkpoint", "part",
                                       "resume-if-there", "force",         "first-pass", "help"};

/// The long names of render's options, without dashes.
std::vector<std::string> render_options() {
  CLI::App program;
  add_render(program);
  std::vector<std::string> names;
  for (const CLI::Option* option : program.get_subcommand("render")->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

class OptionCheck {
 public:
  void operator()(const StudySetting& setting) const {
    if (setting.target != StudyTarget::option) return;
    if (std::find(std::begin(own_options), std::end(own_options), setting.name) !=
        std::end(own_options))
      throw Error(ErrorKind::input,
                  fmt::format("the study itself chooses --{} of its variants", setting.name),
                  "leave it out; 'folder' and 'outputs' say what is written", setting.place);
    if (std::find(known_.begin(), known_.end(), setting.name) == known_.end())
      throw Error(ErrorKind::input, fmt::format("render has no option --{}", setting.name),
                  suggest(setting.name, known_) + "; all of them: kaustik render --help",
                  setting.place);
  }

 private:
  std::vector<std::string> known_ = render_options();
};

/// What any system takes in a file's name, and no shell has a meaning for.
std::string file_name_of(const std::string& label) {
  std::string name = label;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '+' && c != '-') c = '-';
  return name;
}

void add_setting(const StudySetting& setting, const std::string& value,
                 std::vector<std::string>& arguments) {
  switch (setting.target) {
    case StudyTarget::definition:
      arguments.insert(arguments.end(), {"-D", setting.name + "=" + value});
      break;
    case StudyTarget::parameter:
      arguments.insert(arguments.end(), {"--set", setting.name + "=" + value});
      break;
    case StudyTarget::option:
      // As one word: a value may begin with a dash.
      arguments.push_back("--" + setting.name + "=" + value);
  }
}

StudyPart part_of(const Study& study, size_t number) {
  StudyPart part;
  part.arguments = {"render", study.scene};
  for (const StudyOption& option : study.options) {
    if (option.values.empty()) part.arguments.push_back("--" + option.setting.name);
    for (const std::string& value : option.values)
      add_setting(option.setting, value, part.arguments);
  }
  size_t rest = number;
  for (auto factor = study.factors.rbegin(); factor != study.factors.rend(); ++factor) {
    const StudyValue& value = factor->values[rest % factor->values.size()];
    rest /= factor->values.size();
    part.labels.insert(part.labels.begin(), value.label);
    add_setting(factor->setting, value.text, part.arguments);
    const std::string word = file_name_of(factor->label) + "-" + file_name_of(value.label);
    part.name = part.name.empty() ? word : word + "_" + part.name;
  }
  if (part.name.empty()) part.name = "picture";
  if (study.has_seed_for_each) part.arguments.push_back(fmt::format("--seed={}", number));
  for (const std::string& extension : study.outputs)
    part.arguments.insert(part.arguments.end(),
                          {"-o", study.folder + "/" + part.name + "." + extension});
  part.arguments.insert(part.arguments.end(), {"--progress-file", events_file(study, part)});
  return part;
}

/// In single quotes, unless it means itself.
std::string quoted(const std::string& word) {
  const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("-_./=:+,%").find(c) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::vector<StudyPart> parts_of(const Study& study) {
  const OptionCheck check;
  for (const StudyOption& option : study.options) check(option.setting);
  for (const StudyFactor& factor : study.factors) check(factor.setting);
  std::vector<StudyPart> parts;
  std::set<std::string> names;
  for (size_t i = 0; i < study.variant_count(); ++i) {
    parts.push_back(part_of(study, i));
    if (!names.insert(parts.back().name).second)
      throw Error(ErrorKind::input,
                  fmt::format("two variants would be called '{}'", parts.back().name),
                  R"(tell values apart by "names")", study.factors.front().setting.place);
  }
  return parts;
}

std::string events_file(const Study& study, const StudyPart& part) {
  return study.folder + "/" + part.name + ".jsonl";
}
std::string command_file(const Study& study, const StudyPart& part) {
  return study.folder + "/" + part.name + ".command";
}

std::string command_line(const StudyPart& part) {
  std::string line = "kaustik";
  for (const std::string& argument : part.arguments) line += " " + quoted(argument);
  return line;
}

}  // namespace kaustik::app
