#include "kaustik/geometry/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <set>
#include <span>
#include <system_error>

#include "kaustik/base/error.h"
#include "kaustik/base/text_lines.h"

namespace kaustik {
namespace {

class HeaderReader {
 public:
  HeaderReader(const std::string& path, FileWindow& window) : path_(path), window_(window) {}

  PlyHeader read();

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    fail_in_ply(path_, line_, what, remedy);
  }
  std::vector<std::string_view> next_line();
  void add_element(const std::vector<std::string_view>& words);
  void add_property(const std::vector<std::string_view>& words);

  const std::string& path_;
  FileWindow& window_;
  int line_ = 0;
  PlyHeader header_;
  std::set<std::string> element_names_;
  std::string text_;
};

std::vector<std::string_view> HeaderReader::next_line() {
  constexpr size_t longest = 1 << 16;
  const std::span<const uint8_t> ahead = window_.ahead(longest);
  const auto end = std::find(ahead.begin(), ahead.end(), uint8_t(header_.line_end));
  if (end == ahead.end())
    fail("the header has no end", "it is truncated or no PLY file: export it again");
  text_.assign(ahead.begin(), end);
  window_.advance(text_.size() + 1);
  ++line_;
  const std::string_view line = text_;
  std::vector<std::string_view> words;
  constexpr std::string_view blanks = " \t\r";
  for (size_t i = line.find_first_not_of(blanks); i != line.npos;
       i = line.find_first_not_of(blanks, i)) {
    const size_t stop = std::min(line.find_first_of(blanks, i), line.size());
    words.push_back(line.substr(i, stop - i));
    i = stop;
  }
  return words;
}

PlyHeader HeaderReader::read() {
  window_.advance(length_of_byte_order_mark(window_.ahead(3), path_));
  const std::span<const uint8_t> ahead = window_.ahead(5);
  const std::string start(ahead.begin(),
                          ahead.begin() + std::ptrdiff_t(std::min<size_t>(ahead.size(), 5)));
  line_ = 1;
  if (!start.starts_with("ply")) fail("the file does not start with 'ply'", "give a PLY file");
  line_ = 0;
  // How the first line ends tells how all of them do.
  if (start.size() == 5 && start[3] == '\r' && start[4] != '\n') header_.line_end = '\r';
  next_line();
  bool has_format = false;
  while (true) {
    const auto words = next_line();
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3) {
      if (words[1] == "ascii")
        header_.format = PlyFormat::text;
      else if (words[1] == "binary_little_endian")
        header_.format = PlyFormat::little_endian;
      else if (words[1] == "binary_big_endian")
        header_.format = PlyFormat::big_endian;
      else
        fail(fmt::format("unknown format '{}'", words[1]),
             "valid: ascii, binary_little_endian, binary_big_endian");
      has_format = true;
    } else if (words[0] == "element") {
      add_element(words);
    } else if (words[0] == "property") {
      add_property(words);
    } else {
      fail(fmt::format("the header has an unknown line '{}'", words[0]), "export the file again");
    }
  }
  if (!has_format) fail("the header has no 'format' line", "export the file again");
  header_.lines = line_;
  return std::move(header_);
}

void HeaderReader::add_element(const std::vector<std::string_view>& words) {
  PlyElement element;
  if (words.size() != 3) fail("'element' needs a name and a number", "export the file again");
  element.name = words[1];
  const auto [end, error] =
      std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
  if (error != std::errc() || end != words[2].data() + words[2].size())
    fail(fmt::format("'{}' is no number of elements", words[2]), "export the file again");
  if (!element_names_.insert(element.name).second)
    fail(fmt::format("element '{}' is there twice", element.name.substr(0, 40)),
         "export the file again");
  header_.elements.push_back(std::move(element));
}

void HeaderReader::add_property(const std::vector<std::string_view>& words) {
  if (header_.elements.empty())
    fail("a property comes before any element", "export the file again");
  PlyProperty property;
  property.is_list = words.size() == 5 && words[1] == "list";
  if (!property.is_list && words.size() != 3)
    fail("a property needs a type and a name", "export the file again");
  const auto type = [&](std::string_view name) {
    const auto found = ply_type_named(name);
    if (!found)
      fail(fmt::format("unknown type '{}'", name),
           "valid: char, uchar, short, ushort, int, uint, float, double");
    return *found;
  };
  if (property.is_list) property.count_type = type(words[2]);
  property.type = type(words[words.size() - 2]);
  property.name = words.back();
  header_.elements.back().properties.push_back(std::move(property));
}

}  // namespace

PlyHeader read_ply_header(const std::string& path, FileWindow& window) {
  return HeaderReader(path, window).read();
}

void fail_in_ply(const std::string& path, int line, const std::string& what,
                 const std::string& remedy) {
  throw Error(ErrorKind::input, "PLY: " + what, remedy, place_in(path, line));
}

}  // namespace kaustik
