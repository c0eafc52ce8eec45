#include "part_option.h"

#include <fmt/format.h>

#include <charconv>

#include "kaustik/base/error.h"

namespace kaustik::app {

PartNumber parse_part(const std::string& text, uint32_t most_parts) {
  uint32_t number = 0, count = 0;
  const char* const end = text.data() + text.size();
  const auto [slash, code] = std::from_chars(text.data(), end, number);
  if (code == std::errc{} && slash != end && *slash == '/') {
    const auto [last, second_code] = std::from_chars(slash + 1, end, count);
    if (second_code == std::errc{} && last == end && number >= 1 && number <= count &&
        count <= most_parts)
      return {number - 1, count};
  }
  throw Error(ErrorKind::input, fmt::format("cannot read the part '{}'", text),
              fmt::format("write the number of the part, from 1 on, and how many there are, at "
                          "most {}: --part 2/4",
                          most_parts),
              place_in("command line: --part"));
}

}  // namespace kaustik::app
