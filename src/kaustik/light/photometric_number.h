#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace kaustik {

/// The finite number that a word of a photometric file is as a whole; a comma is its point.
inline std::optional<double> photometric_number(std::string_view word) {
  std::string text(word);
  std::replace(text.begin(), text.end(), ',', '.');
  const char* first = text.data();
  const char* const last = first + text.size();
  if (first != last && *first == '+') ++first;
  double value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace kaustik
