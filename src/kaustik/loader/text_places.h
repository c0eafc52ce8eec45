#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik {

/// Where letters of a text stand in the file that it was read from.
class TextPlaces {
 public:
  /// Unless the text may be quoted, places have no column, so that no error shows an excerpt.
  TextPlaces(std::string_view text, std::string file, bool may_be_quoted);
  Place at(size_t offset) const;

 private:
  std::shared_ptr<const std::string> file_;
  std::vector<size_t> line_starts_;
  bool may_be_quoted_;
};

}  // namespace kaustik
