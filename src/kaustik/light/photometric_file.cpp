#include "kaustik/light/photometric_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/text_lines.h"
#include "kaustik/light/photometric_number.h"

namespace kaustik {
namespace {

bool ends_in(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size()) return false;
  return std::ranges::equal(name.substr(name.size() - ending.size()), ending,
                            [](char a, char b) { return (a | 0x20) == (b | 0x20); });
}

/// Whether lines 3 and 4 can be the symmetry and the number of planes.
bool is_eulumdat(std::string_view head) {
  for (int line = 1; line <= 4; ++line) {
    const size_t end = head.find('\n');
    if (end == std::string_view::npos) return false;
    const std::string_view text = trimmed(head.substr(0, end));
    head.remove_prefix(end + 1);
    const auto number = line >= 2 ? photometric_number(text) : std::nullopt;
    if (line >= 2 && !number) return false;
    if (line == 3 && !(*number >= 0 && *number <= 4)) return false;
    if (line == 4 && !(*number >= 1)) return false;
  }
  return true;
}

/// Pictures have zeros among their first bytes, or their own first words.
bool is_ies(std::string_view head) {
  if (head.substr(0, 64).find('\0') != std::string_view::npos) return false;
  return head.starts_with("IES") || head.find("TILT") != std::string_view::npos;
}

}  // namespace

bool is_photometry(const std::string& name, std::string_view head) {
  return ends_in(name, ".ies") || ends_in(name, ".ldt") || is_ies(head) || is_eulumdat(head);
}

Photometry read_photometry(std::string_view text, const std::string& name) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const bool is_european = is_eulumdat(text) || (ends_in(name, ".ldt") && !is_ies(text));
  return is_european ? read_eulumdat(text, name) : read_ies(text, name);
}

}  // namespace kaustik
