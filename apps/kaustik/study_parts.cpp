#include "study_parts.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "commands.h"
#include "kaustik/base/error.h"
#include "shell_words.h"

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
  void operator()(const StudySetting& setting) {
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
    constexpr const char* repeatable = "set";
    if (setting.name != repeatable && !given_.insert(setting.name).second)
      throw Error(ErrorKind::input, fmt::format("--{} is given twice", setting.name),
                  "keep it among 'options', or as a factor; \"seed\": \"each\" gives --seed",
                  setting.place);
  }
  void take_seed() { given_.insert("seed"); }

 private:
  std::vector<std::string> known_ = render_options();
  std::set<std::string> given_;
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

/// The options of all parts, and those of the factors' values, which give the part its name.
std::vector<std::string> settings_of(const Study& study, size_t number, StudyPart& part) {
  std::vector<std::string> arguments;
  for (const StudyOption& option : study.options) {
    if (option.values.empty()) arguments.push_back("--" + option.setting.name);
    for (const std::string& value : option.values) add_setting(option.setting, value, arguments);
  }
  size_t rest = number;
  for (auto factor = study.factors.rbegin(); factor != study.factors.rend(); ++factor) {
    const StudyValue& value = factor->values[rest % factor->values.size()];
    rest /= factor->values.size();
    part.labels.insert(part.labels.begin(), value.label);
    add_setting(factor->setting, value.text, arguments);
    const std::string word = file_name_of(factor->label) + "-" + file_name_of(value.label);
    part.name = part.name.empty() ? word : word + "_" + part.name;
  }
  if (part.name.empty()) part.name = "picture";
  if (study.has_seed_for_each) arguments.push_back(fmt::format("--seed={}", number));
  return arguments;
}

StudyPart part_of(const Study& study, size_t number) {
  StudyPart part;
  const std::vector<std::string> settings = settings_of(study, number, part);
  const auto arguments = [&](const std::string& scene, const std::string& folder) {
    std::vector<std::string> all{"render", scene};
    all.insert(all.end(), settings.begin(), settings.end());
    for (const std::string& extension : study.outputs)
      all.insert(all.end(), {"-o", folder + part.name + "." + extension});
    all.insert(all.end(), {"--progress-file", folder + part.name + ".jsonl"});
    return all;
  };
  part.arguments = arguments(study.scene, study.folder + "/");
  part.command = command_line(arguments(study.scene_as_written, ""));
  return part;
}

}  // namespace

std::vector<StudyPart> parts_of(const Study& study) {
  OptionCheck check;
  if (study.has_seed_for_each) check.take_seed();
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

std::string command_line(const std::vector<std::string>& arguments) {
  std::string line = "kaustik";
  for (const std::string& argument : arguments) line += " " + quoted_for_shell(argument);
  return line;
}

}  // namespace kaustik::app
