#include "benchmarks/comparisons/result_lines.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "kaustik/base/error.h"

namespace kaustik::bench {

double number_of(const nlohmann::json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::optional<double> known(double value) {
  if (std::isnan(value)) return std::nullopt;
  return value;
}

void for_each_line(const std::string& path, const std::string& name,
                   const std::function<void(const nlohmann::json&)>& visit) {
  std::ifstream file(path);
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    if (text.empty()) continue;
    try {
      const nlohmann::json line = nlohmann::json::parse(text);
      if (line.value("name", "") == name) visit(line);
    } catch (const nlohmann::json::exception& problem) {
      throw Error(ErrorKind::input,
                  fmt::format("{}:{}: not a result: {}", path, number, problem.what()),
                  "remove the line; a run that was cut short may have left a part of one");
    }
  }
}

}  // namespace kaustik::bench
