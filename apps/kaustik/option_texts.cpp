// What the texts of options say.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "commands.h"
#include "kaustik/base/error.h"

namespace kaustik::app {

double parse_duration(const std::string& text, const std::string& option) {
  // Longer ones would leave the range of clocks.
  constexpr double longest_s = 1e9;
  const auto fail = [&] {
    throw Error(ErrorKind::input, fmt::format("cannot read the time '{}'", text),
                "write a positive number of seconds (60s), minutes (5m), hours (1h), or 1h30m, up "
                "to 30 years",
                place_in("command line: " + option));
  };
  double seconds = 0, last_unit = std::numeric_limits<double>::infinity();
  const char *at = text.data(), *const last = text.data() + text.size();
  do {
    double value = 0;
    const auto [end, code] = std::from_chars(at, last, value, std::chars_format::fixed);
    const char* const next = std::find_if(end, last, [](char c) { return !std::isalpha(c); });
    const std::string name(end, next);
    const double unit = name == "s" || (name.empty() && at == text.data() && end == last) ? 1
                        : name == "m" || name == "min"                                    ? 60
                        : name == "h"                                                     ? 3600
                                                                                          : 0;
    if (code != std::errc{} || unit == 0 || !(unit < last_unit) || !(value >= 0)) fail();
    seconds += value * unit;
    last_unit = unit;
    at = next;
  } while (at != last);
  if (!(seconds > 0) || !(seconds <= longest_s)) fail();
  return seconds;
}

double parse_error_bound(const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  if (code != std::errc{} || (unit != "%" && unit != " %") || !(value > 0) || !std::isfinite(value))
    throw Error(ErrorKind::input, fmt::format("cannot read the error '{}'", text),
                "write a positive number of percent: 2%", place_in("command line: --error"));
  return value / 100;
}

std::vector<std::pair<std::string, std::string>> parse_definitions(
    const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, std::string>> definitions;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorKind::input, fmt::format("cannot read the definition '{}'", text),
                  "write -D name=value", place_in("command line: -D"));
    definitions.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return definitions;
}

}  // namespace kaustik::app
