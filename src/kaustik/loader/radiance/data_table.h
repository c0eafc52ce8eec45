#pragma once
#include <span>
#include <string_view>
#include <vector>

namespace kaustik::radiance {

/// A table of Radiance's data files (.dat): numbers over 1 to 4 coordinates, linear between.
class DataTable {
 public:
  /// Throws CalError for what is none.
  explicit DataTable(std::string_view text);

  size_t dimensions() const { return axes_.size(); }
  /// Beyond its ends a table goes on as at them. `point` has as many numbers as dimensions.
  double at(std::span<const double> point) const;
  double mean() const;

 private:
  std::vector<std::vector<double>> axes_;  ///< ascending or descending
  std::vector<double> values_;             ///< the last coordinate runs fastest
};

}  // namespace kaustik::radiance
