#pragma once
#include <fmt/format.h>

#include "benchmarks/comparisons/error_ratio.h"

namespace kaustik::bench {

inline std::string cell(const std::optional<double>& value, const char* format = "{:.2g}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "–";
}

inline std::string cell(const std::optional<ErrorRatio>& ratio) {
  return ratio ? ratio->text() : "–";
}

}  // namespace kaustik::bench
