#include "kaustik/loader/reader_definitions.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kaustik {

ReaderDefinitions::ReaderDefinitions(const LoadOptions& options,
                                     const std::vector<ReaderDefinition>& known)
    : origin_(place_in(options.definitions_origin)) {
  std::vector<std::string> names;
  for (const ReaderDefinition& definition : known) names.push_back(definition.name);
  Problems problems;
  for (const auto& [name, value] : options.definitions) {
    const auto row = std::find(names.begin(), names.end(), name);
    if (row == names.end()) {
      problems.add(fmt::format("files of this format know no definition '{}'", name),
                   names.empty() ? "leave it out" : suggest(name, names), origin_);
      continue;
    }
    if (find(name)) {
      problems.add(fmt::format("'{}' is defined twice", name), "keep one definition", origin_);
      continue;
    }
    const std::vector<std::string>& choices = known[size_t(row - names.begin())].choices;
    if (!choices.empty() && std::find(choices.begin(), choices.end(), value) == choices.end())
      problems.add(fmt::format("'{}' cannot be '{}'", name, value), suggest(value, choices),
                   origin_);
    given_.emplace_back(name, value);
  }
  problems.throw_if_any();
}

const std::string* ReaderDefinitions::find(std::string_view name) const {
  for (const auto& [given, value] : given_)
    if (given == name) return &value;
  return nullptr;
}

double ReaderDefinitions::number(std::string_view name, double usual, double least) const {
  const std::string* text = find(name);
  if (!text) return usual;
  double value = 0;
  const char* const last = text->data() + text->size();
  const auto [end, error] = std::from_chars(text->data(), last, value);
  if (error != std::errc() || end != last || !std::isfinite(value) || value < least)
    throw Error(ErrorKind::input, fmt::format("'{}' cannot be '{}'", name, *text),
                fmt::format("give a number, at least {}", least), origin_);
  return value;
}

}  // namespace kaustik
