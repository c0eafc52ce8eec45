#include "kaustik/base/number_list.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kaustik {

NumberList parse_number_list(std::string_view text) {
  constexpr std::string_view separators = ",; \t\r\n";
  NumberList list;
  for (size_t begin = text.find_first_not_of(separators); begin != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(separators, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    double number = 0;
    const bool has_plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    const auto [stop, error] =
        std::from_chars(word.data() + has_plus, word.data() + word.size(), number);
    if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(number)) {
      list.wrong_word = word.substr(0, 60);
      return list;
    }
    list.numbers.push_back(number);
    begin = text.find_first_not_of(separators, end);
  }
  return list;
}

}  // namespace kaustik
