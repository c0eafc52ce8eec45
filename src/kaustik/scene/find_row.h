#pragma once
#include <string>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/base/parameters.h"

namespace kaustik {

inline const TypeInfo& info_of(const TypeInfo& info) { return info; }
template <typename Row>
const TypeInfo& info_of(const Row& row) {
  return row.info;
}

/// The row of a registry; null: there is none of that name.
template <typename Row>
const Row* find_row(const std::vector<Row>& rows, const std::string& name) {
  for (const Row& row : rows)
    if (info_of(row).name == name) return &row;
  return nullptr;
}

template <typename Row>
std::vector<std::string> names_of(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const Row& row : rows) names.push_back(info_of(row).name);
  return names;
}

/// Whether a name looks like a slip of the pen in one of these: it is near to it, and not that name
/// with a word more ("codedperspective", "ptracer_c"), which somebody's own type has.
inline bool is_slip_of_pen(const std::string& name, const std::vector<std::string>& valid) {
  const std::string nearest = nearest_name(name, valid);
  if (nearest.empty()) return false;
  return name.size() < nearest.size() + 2 || name.find(nearest) == std::string::npos;
}

}  // namespace kaustik
