#include "kaustik/scene/direction_file.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"
#include "kaustik/base/number_list.h"
#include "kaustik/base/text_lines.h"

namespace kaustik {
namespace {

constexpr const char* remedy =
    "write six numbers on each line: x, y, z of the place, and of the direction";

[[noreturn]] void fail(const std::string& message, const Place& place) {
  throw Error(ErrorKind::input, message, remedy, place);
}

}  // namespace

std::vector<DirectedPlace> read_direction_file(const std::string& path, size_t most) {
  std::vector<DirectedPlace> rows;
  TextLines lines(path);
  bool may_be_title = true;
  for (std::string_view line; lines.next(line);) {
    const std::string_view text = trimmed(line.substr(0, line.find('#')));
    if (text.empty()) continue;
    const Place place = place_in(path, lines.number());
    const bool is_title =
        may_be_title && text.find_first_of("0123456789") == std::string_view::npos;
    may_be_title = false;
    if (is_title) continue;
    const NumberList list = parse_number_list(text);
    if (!list.wrong_word.empty()) fail(fmt::format("'{}' is not a number", list.wrong_word), place);
    if (list.numbers.size() != 6)
      fail(fmt::format("there are {} numbers", list.numbers.size()), place);
    const auto& n = list.numbers;
    rows.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
    if (rows.back().direction == Vec3d(0, 0, 0)) fail("the direction is zero", place);
    if (rows.size() > most) fail(fmt::format("there are more than {} rows", most), place);
  }
  if (rows.empty()) fail("there is no row of numbers", place_in(path));
  return rows;
}

}  // namespace kaustik
