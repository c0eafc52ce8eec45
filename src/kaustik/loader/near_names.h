#pragma once
// Remedies for names that are none.

#include <string>
#include <string_view>
#include <vector>

namespace kaustik {

/// "did you mean 'x'?", of the nearest name, for a remedy; "" where none is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// The first of the names that a map knows: so many that a file which misspells all of its names
/// is read in time all the same.
template <typename Map>
std::vector<std::string> names_in(const Map& map) {
  constexpr size_t most_names = 1000;
  std::vector<std::string> names;
  for (const auto& entry : map) {
    if (names.size() == most_names) break;
    names.emplace_back(entry.first);
  }
  return names;
}

}  // namespace kaustik
