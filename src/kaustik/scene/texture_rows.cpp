#include "kaustik/scene/texture_rows.h"

#include <variant>

namespace kaustik {

std::vector<std::string> texture_parameters(const TypeInfo& info) {
  std::vector<std::string> names;
  for (const Parameter& row : info.parameters)
    if (row.accepts_texture) names.push_back(row.name);
  return names;
}

const Parameter* texture_parameter(const TypeInfo& info, const std::string& name) {
  const Parameter* only = nullptr;
  int count = 0;
  for (const Parameter& row : info.parameters) {
    if (!row.accepts_texture) continue;
    if (row.name == name) return &row;
    if (!std::holds_alternative<std::monostate>(row.default_value)) continue;
    only = &row;
    ++count;
  }
  return count == 1 && !info.find(name) ? only : nullptr;
}

}  // namespace kaustik
