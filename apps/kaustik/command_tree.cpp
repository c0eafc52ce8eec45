#include "command_tree.h"

namespace kaustik::app {
namespace {

OptionText text_of(const CLI::Option& option) {
  OptionText text;
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  text.sentence = option.get_description();
  text.values = values_of(&option);
  text.takes_value = option.get_items_expected_max() > 0;
  text.may_have_value = !text.takes_value && text.values.kind != OptionValues::Kind::other;
  if (text.names.empty())
    text.value = option.get_name(true);
  else if (text.takes_value)
    text.value = option.get_type_name();
  text.may_repeat = option.get_items_expected_max() > 1;
  text.is_required = option.get_required();
  return text;
}

}  // namespace

CommandText text_of(const CLI::App& command) {
  CommandText text;
  text.name = command.get_name();
  text.group = command.get_group();
  text.sentence = command.get_description();
  text.footer = command.get_footer();
  for (const CLI::Option* option : command.get_options()) {
    OptionText row = text_of(*option);
    (row.names.empty() ? text.arguments : text.options).push_back(std::move(row));
  }
  return text;
}

std::vector<CommandText> command_texts(const CLI::App& program) {
  std::vector<CommandText> texts;
  for (const CLI::App* command : program.get_subcommands({})) texts.push_back(text_of(*command));
  return texts;
}

}  // namespace kaustik::app
