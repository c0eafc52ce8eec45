#pragma once
#include <string>
#include <vector>

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

}  // namespace kaustik
