#pragma once
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace kaustik::radiance {

/// Of a whole word; nothing where it is none, or is not finite.
inline std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

}  // namespace kaustik::radiance
