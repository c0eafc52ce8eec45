#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace kaustik {

/// The numbers of a text such as "0.1, 0.5 2".
struct NumberList {
  std::vector<double> numbers;
  /// The first word that is no finite number, cut after 60 characters; empty: there is none. The
  /// numbers are those before it.
  std::string wrong_word;
};

/// Between numbers stand commas, semicolons, blanks or ends of lines.
NumberList parse_number_list(std::string_view text);

}  // namespace kaustik
