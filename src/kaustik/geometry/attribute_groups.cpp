#include "kaustik/geometry/attribute_groups.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string_view>

namespace kaustik {
namespace {

using Names = std::vector<std::string>;

std::optional<AttributeGroup> colours_named(const Names& properties,
                                            const std::array<std::string_view, 3>& names) {
  AttributeGroup group{"color", {}};
  for (const std::string_view name : names) {
    const auto found = std::find(properties.begin(), properties.end(), name);
    if (found == properties.end()) return std::nullopt;
    group.members.push_back(size_t(found - properties.begin()));
  }
  return group;
}

/// What a mesh has anyway, or what its colours are.
bool is_reserved(const std::string& name) {
  static const std::set<std::string_view> names = {
      "x",         "y", "z", "nx", "ny",  "nz",    "u",    "v",     "s",        "t",
      "texture_u", "r", "g", "b",  "red", "green", "blue", "alpha", "texture_v"};
  return names.contains(name);
}

/// The words before the last letter, and that; no letter where it is no part of a name.
struct SplitName {
  std::string_view words;
  char letter = 0;
};
SplitName split_name(const std::string& name) {
  const size_t line = name.rfind('_');
  if (is_reserved(name) || line == name.npos || line == 0 || line + 2 != name.size()) return {};
  return {std::string_view(name).substr(0, line), name.back()};
}

/// The letters that go on after a first one; empty where none does.
std::string_view letters_from(char first) {
  constexpr std::string_view rows[] = {"xyzw", "rgba", "0123", "1234"};
  for (const std::string_view row : rows)
    if (row[0] == first) return row;
  return {};
}

}  // namespace

std::vector<AttributeGroup> attribute_groups(const Names& properties) {
  std::vector<AttributeGroup> groups;
  if (auto colours = colours_named(properties, {"r", "g", "b"}))
    groups.push_back(std::move(*colours));
  else if (auto more = colours_named(properties, {"red", "green", "blue"}))
    groups.push_back(std::move(*more));
  std::set<std::string> known;
  for (const AttributeGroup& group : groups) known.insert(group.name);
  for (size_t i = 0; i < properties.size();) {
    const SplitName first = split_name(properties[i]);
    const std::string_view letters = letters_from(first.letter);
    size_t count = 0;
    for (; count < letters.size() && i + count < properties.size(); ++count) {
      const SplitName next = split_name(properties[i + count]);
      if (next.letter != letters[count] || next.words != first.words) break;
    }
    const bool is_colour = letters.starts_with('r');
    if (count == 1 || count == 3 || (count == 4 && is_colour)) {
      AttributeGroup group{std::string(first.words) + (is_colour ? "_color" : ""), {}};
      for (size_t k = 0; k < std::min<size_t>(count, 3); ++k) group.members.push_back(i + k);
      if (known.insert(group.name).second) groups.push_back(std::move(group));
    }
    i += std::max<size_t>(count, 1);
  }
  return groups;
}

}  // namespace kaustik
