#include <fmt/format.h>

#include <algorithm>

#include "commands.h"
#include "exit_codes.h"
#include "kaustik/base/limits.h"
#include "kaustik/image/tone_mapping.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/scene/type_tables.h"
#include "option_values.h"
#include "thesis_settings.h"

namespace kaustik::app {
namespace {

/// Every type that has a table, family by family.
std::vector<const TypeInfo*> all_types() {
  TypeTables types;
  types.add_rows(integrator_types());
  types.add_rows(foreign_integrators());
  types.add(scene_types());
  types.add_rows(tone_operator_types());
  return types.all();
}

std::string range_text(const Parameter& p) {
  if (p.kind == ParameterKind::array) return extents_text(p);
  // What holds for every coordinate goes without saying.
  if (p.kind == ParameterKind::point && p.maximum == largest_length) return {};
  const bool low = std::isfinite(p.minimum), high = std::isfinite(p.maximum) && p.maximum < 1e30;
  if (low && high) return fmt::format("{} … {}", p.minimum, p.maximum);
  if (low) return fmt::format("≥ {}", p.minimum);
  if (high) return fmt::format("≤ {}", p.maximum);
  return {};
}

void print_table(const TypeInfo& info) {
  fmt::print("{} type=\"{}\"\n  {}\n", info.family, info.name, info.sentence);
  for (const Parameter& p : info.parameters) {
    if (p.no_effect) continue;
    fmt::print("\n  {} ({}", p.name, kind_name(p.kind));
    if (p.required) fmt::print(", required");
    if (const std::string text = default_text(p); !text.empty()) fmt::print(", default {}", text);
    if (const std::string range = range_text(p); !range.empty()) fmt::print(", {}", range);
    if (!p.unit.empty()) fmt::print(", {}", p.unit);
    if (p.accepts_texture) fmt::print(", or a texture");
    if (p.accepts_volume) fmt::print(", or a volume");
    fmt::print(")\n      {}\n", p.sentence);
    if (!p.choices.empty()) fmt::print("      One of: {}\n", fmt::join(p.choices, ", "));
  }
  std::vector<std::string> ignored;
  for (const Parameter& p : info.parameters)
    if (p.no_effect) ignored.push_back(p.name);
  if (!ignored.empty()) fmt::print("\n  Accepted, no effect: {}\n", fmt::join(ignored, ", "));
}

/// All that there is help for.
std::vector<std::string> topics() {
  std::vector<std::string> names{"exit", "thesis"};
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const TypeInfo* info : all_types()) add(info->family);
  for (const TypeInfo* info : all_types()) add(info->name);
  return names;
}

void help(const std::string& name) {
  if (name == "thesis") return print_thesis_variables();
  if (name == "exit") return fmt::print("{}\n", exit_code_text());
  std::vector<std::string> names;
  bool found = false;
  const ForeignIntegrator* foreign = find_foreign_integrator(name);
  for (const TypeInfo* info : all_types()) {
    if (info->name == name || info->family == name || (foreign && info == &foreign->info)) {
      if (found) fmt::print("\n");
      print_table(*info);
      found = true;
    }
    names.push_back(info->name);
  }
  if (found) return;
  if (!name.empty())
    throw Error(ErrorKind::input, fmt::format("there is no type '{}'", name), suggest(name, names));
  fmt::print(
      "kaustik help TYPE prints the parameters of a type; kaustik help exit lists the exit codes. "
      "Types:\n");
  std::string family;
  for (const TypeInfo* info : all_types()) {
    if (info->family != family) fmt::print("\n{}\n", family = info->family);
    fmt::print("  {:16} {}\n", info->name, info->sentence);
  }
}

}  // namespace

void add_help(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("help", "Print the parameters of a type, or list all types.");
  auto name = std::make_shared<std::string>();
  takes_words_of(command->add_option("type", *name,
                                     "Type or family, such as photonmap, bsdf, film; \"thesis\" "
                                     "for environment variables; \"exit\" for exit codes"),
                 topics, "TYPE");
  command->callback([name] { help(*name); });
}

}  // namespace kaustik::app
