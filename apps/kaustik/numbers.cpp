#include "numbers.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace kaustik::app {
namespace {

/// CLI11 takes a text for what is wrong, "" for nothing.
CLI::Validator validator(std::function<std::string(std::string&)> check, const std::string& range) {
  return {std::move(check), range, "number"};
}

}  // namespace

CLI::Validator whole_number(int64_t least, int64_t most) {
  const std::string range = fmt::format("{} … {}", least, most);
  return validator(
      [=](std::string& text) -> std::string {
        int64_t value = 0;
        const char* const last = text.data() + text.size();
        const auto [end, code] = std::from_chars(text.data(), last, value);
        if (end != last || code == std::errc::invalid_argument)
          return fmt::format("'{}' is not a whole number", text);
        if (code != std::errc{} || value < least || value > most)
          return fmt::format("{} is out of range: {}", text, range);
        return {};
      },
      range);
}

CLI::Validator number_between(double low, double high) {
  const std::string range = std::isfinite(high) ? fmt::format("between {} and {}", low, high)
                                                : fmt::format("greater than {}", low);
  return validator(
      [=](std::string& text) -> std::string {
        double value = 0;
        const char* const last = text.data() + text.size();
        const auto [end, code] = std::from_chars(text.data(), last, value);
        if (end != last || code == std::errc::invalid_argument || std::isnan(value))
          return fmt::format("'{}' is not a number", text);
        if (code != std::errc{} || !(value > low && value < high))
          return fmt::format("{} is out of range: {}", text, range);
        return {};
      },
      range);
}

}  // namespace kaustik::app
