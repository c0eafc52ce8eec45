#pragma once
#include <string_view>
#include <vector>

#include "kaustik/base/parameters.h"

namespace kaustik {

/// The tables of many types, family by family: what may be asked about an object and its properties
/// without knowing what makes them.
class TypeTables {
 public:
  /// `info` must outlive this.
  void add(const TypeInfo& info) { tables_.push_back(&info); }
  /// All tables of a registry, whose rows hold their `info`.
  template <typename Rows>
  void add_rows(const Rows& rows) {
    for (const auto& row : rows) add(row.info);
  }
  void add(const TypeTables& others) {
    tables_.insert(tables_.end(), others.tables_.begin(), others.tables_.end());
  }

  /// In the order in which they were added.
  const std::vector<const TypeInfo*>& all() const { return tables_; }
  /// Null: there is no such type.
  const TypeInfo* find(std::string_view family, std::string_view type) const {
    for (const TypeInfo* info : tables_)
      if (info->name == type && info->family == family) return info;
    return nullptr;
  }

 private:
  std::vector<const TypeInfo*> tables_;
};

}  // namespace kaustik
