#pragma once
#include <cstdint>
#include <string>

namespace kaustik::app {

/// Part `index`, from 0 on, of `count`.
struct PartNumber {
  uint32_t index = 0, count = 1;
};

/// --part: "2/4" is part 2 of 4, of at most so many. Throws Error(input).
PartNumber parse_part(const std::string& text, uint32_t most_parts);

}  // namespace kaustik::app
