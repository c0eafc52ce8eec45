#include "kaustik/loader/mitsuba_definitions.h"

#include <fmt/format.h>

#include <cctype>
#include <vector>

#include "kaustik/loader/mitsuba_values.h"

namespace kaustik::mitsuba {
namespace {

/// Definitions that use one another could otherwise grow without bounds.
constexpr size_t maximum_replaced_bytes = size_t{64} << 20;
/// A '$' is compared with names of every length that there is: this bounds how many.
constexpr size_t maximum_name = 200;

std::string_view name_at(std::string_view text) {
  size_t length = 0;
  while (length < text.size() &&
         (std::isalnum(static_cast<unsigned char>(text[length])) || text[length] == '_'))
    ++length;
  return text.substr(0, length);
}

}  // namespace

Definitions::Definitions(const LoadOptions& options, Problems& problems)
    : origin_(place_in(options.definitions_origin)), prefix_(options.definition_prefix) {
  for (const auto& [name, value] : options.definitions) {
    if (name.empty() || name_at(name) != name)
      problems.add(fmt::format("{} cannot be the name of a definition", in_quotes(name)),
                   "names are made of letters, digits and '_'", origin_);
    else if (definitions_.contains(name))
      problems.add(fmt::format("{} is defined twice", in_quotes(name)), "keep one definition",
                   origin_);
    else
      insert(name, {value, false});
  }
}

void Definitions::insert(const std::string& name, Definition definition) {
  definitions_.emplace(name, std::move(definition));
  lengths_.insert(name.size());
}

Definitions::Entry* Definitions::longest_at(std::string_view text) {
  text = text.substr(0, text.find('$'));  // no name holds one
  for (auto length = lengths_.rbegin(); length != lengths_.rend(); ++length) {
    if (*length > text.size()) continue;
    const auto found = definitions_.find(text.substr(0, *length));
    if (found != definitions_.end()) return &*found;
  }
  return nullptr;
}

void Definitions::set_default(const std::string& name, const std::string& value) {
  if (name.empty())
    throw BadValue("a <default> without a name", "give the name that $name stands for");
  if (name.size() > maximum_name || name.find('$') != std::string::npos)
    throw BadValue(fmt::format("{} cannot be the name of a <default>", in_quotes(name)),
                   fmt::format("use at most {} letters, digits and '_'", maximum_name));
  known_.insert(name);
  if (const auto defined = definitions_.find(name); defined != definitions_.end())
    defined->second.used = true;
  else
    insert(name, {value, true});
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
      Entry* entry = longest_at(rest);
      if (!entry) fail_undefined(name_at(rest));
      auto& [name, definition] = *entry;
      if (!definition.used) known_.insert(name);
      definition.used = true;
      replaced_bytes_ += definition.value.size();
      if (replaced_bytes_ > maximum_replaced_bytes)
        throw BadValue("the values of <default> elements fill more than 64 MiB",
                       "use shorter values");
      result += definition.value;
      i += 1 + name.size();
    }
  }
  return result;
}

void Definitions::fail_undefined(std::string_view name) const {
  if (name.empty()) throw BadValue("a '$' without a name", "write \\$ for a dollar sign itself");
  std::vector<std::string> names;
  for (const auto& [known, definition] : definitions_) names.push_back(known);
  name = name.substr(0, maximum_name);
  std::string remedy =
      fmt::format("define it: {}{}=…, or <default name=\"{}\" value=\"…\"/>", prefix_, name, name);
  const std::string others = names.empty() ? "" : suggestion(name, names);
  throw BadValue(fmt::format("${} is not defined", name),
                 others.empty() ? remedy : remedy + "; " + others);
}

void Definitions::report_unused(Problems& problems) const {
  const std::vector<std::string> names(known_.begin(), known_.end());
  for (const auto& [name, definition] : definitions_)
    if (!definition.used)
      problems.add(fmt::format("the scene does not use '{}', which is defined", name),
                   names.empty()
                       ? "the scene has no <default> and uses no $name: leave the definition out"
                       : suggestion(name, names),
                   origin_);
}

}  // namespace kaustik::mitsuba
