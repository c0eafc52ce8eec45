#pragma once
// Results files: lines of JSON, each with the name of its kind.
#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>

namespace kaustik::bench {

/// JSON has no NaN: what there is none of is null.
double number_of(const nlohmann::json& value);

/// Nothing for NaN.
std::optional<double> known(double value);

/// visit(line) for those of that name, in their order; none without the file. Throws Error(input)
/// for lines that are no JSON, or that `visit` cannot read.
void for_each_line(const std::string& path, const std::string& name,
                   const std::function<void(const nlohmann::json&)>& visit);

}  // namespace kaustik::bench
