#include "kaustik/loader/text_places.h"

#include <algorithm>

namespace kaustik {

TextPlaces::TextPlaces(std::string_view text, std::string file, bool may_be_quoted)
    : file_(std::make_shared<const std::string>(std::move(file))),
      line_starts_{0},
      may_be_quoted_(may_be_quoted) {
  for (size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') line_starts_.push_back(i + 1);
}

Place TextPlaces::at(size_t offset) const {
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const auto line = next - line_starts_.begin();
  return {file_, int(line), may_be_quoted_ ? int(offset - *(next - 1)) + 1 : 0};
}

}  // namespace kaustik
