#include "kaustik/loader/mitsuba_definitions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "kaustik/loader/mitsuba_values.h"

namespace kaustik::mitsuba {
namespace {

/// Definitions that use one another could otherwise grow without bounds.
constexpr size_t maximum_replaced_bytes = size_t{64} << 20;

std::string_view name_at(std::string_view text) {
  size_t length = 0;
  while (length < text.size() &&
         (std::isalnum(static_cast<unsigned char>(text[length])) || text[length] == '_'))
    ++length;
  return text.substr(0, length);
}

}  // namespace

Definitions::Definitions(const LoadOptions& options, Problems& problems) {
  const Place command_line = place_in("command line");
  for (const auto& [name, value] : options.definitions) {
    if (name.empty() || name_at(name) != name)
      problems.add(fmt::format("{} cannot be the name of a definition", in_quotes(name)),
                   "names are made of letters, digits and '_'", command_line);
    else if (find(name))
      problems.add(fmt::format("'{}' is defined twice", name), "keep one definition", command_line);
    else
      insert({name, value, false});
  }
}

Definitions::Definition* Definitions::find(std::string_view name) {
  for (Definition& definition : definitions_)
    if (definition.name == name) return &definition;
  return nullptr;
}

void Definitions::insert(Definition definition) {
  const auto shorter = std::find_if(
      definitions_.begin(), definitions_.end(),
      [&](const Definition& other) { return other.name.size() < definition.name.size(); });
  definitions_.insert(shorter, std::move(definition));
}

Definitions::Definition* Definitions::longest_at(std::string_view text) {
  for (Definition& definition : definitions_)
    if (text.starts_with(definition.name)) return &definition;
  return nullptr;
}

void Definitions::set_default(const std::string& name, const std::string& value) {
  known_.insert(name);
  if (Definition* definition = find(name))
    definition->used = true;
  else
    insert({name, value, true});
}

std::string Definitions::replace(std::string_view text) {
  if (text.find('$') == std::string_view::npos) return std::string(text);
  std::string result;
  for (size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with("\\$")) {
      result += '$';
      i += 2;
    } else if (text[i] != '$') {
      result += text[i++];
    } else {
      const std::string_view rest = text.substr(i + 1);
      Definition* definition = longest_at(rest);
      if (!definition) fail_undefined(name_at(rest));
      known_.insert(definition->name);
      definition->used = true;
      replaced_bytes_ += definition->value.size();
      if (replaced_bytes_ > maximum_replaced_bytes)
        throw BadValue("the values of <default> elements fill more than 64 MiB",
                       "use shorter values");
      result += definition->value;
      i += 1 + definition->name.size();
    }
  }
  return result;
}

void Definitions::fail_undefined(std::string_view name) const {
  if (name.empty()) throw BadValue("a '$' without a name", "write \\$ for a dollar sign itself");
  std::vector<std::string> names;
  for (const Definition& definition : definitions_) names.push_back(definition.name);
  std::string remedy =
      fmt::format("define it with -D {}=… or <default name=\"{}\" value=\"…\"/>", name, name);
  const std::string others = names.empty() ? "" : suggestion(name, names);
  throw BadValue(fmt::format("${} is not defined", name),
                 others.empty() ? remedy : remedy + "; " + others);
}

void Definitions::report_unused(Problems& problems) const {
  const std::vector<std::string> names(known_.begin(), known_.end());
  for (const Definition& definition : definitions_)
    if (!definition.used)
      problems.add(fmt::format("the scene does not use '{}', which -D defines", definition.name),
                   names.empty() ? "the scene has no <default> and uses no $name: leave out -D"
                                 : suggestion(definition.name, names),
                   place_in("command line"));
}

}  // namespace kaustik::mitsuba
