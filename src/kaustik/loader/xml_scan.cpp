#include "kaustik/loader/xml_scan.h"

#include <algorithm>

namespace kaustik {
namespace {

constexpr size_t nowhere = std::string_view::npos;

/// The end of a DOCTYPE, in whose brackets declarations, comments and quoted text may hold a '>'.
size_t end_of_doctype(std::string_view text, size_t begin) {
  bool in_brackets = false;
  for (size_t i = begin + 1; i < text.size();) {
    const char c = text[i];
    if (c == '>' && !in_brackets) return i + 1;
    if (c == '[' || c == ']') in_brackets = c == '[';
    if (c == '"' || c == '\'')
      i = text.find(c, i + 1);
    else if (c == '<' && i + 1 < text.size() && text[i + 1] == '!' && text.substr(i, 4) != "<!--")
      i = end_of_tag(text, i) - 1;
    else if (c == '<')
      i = end_of_special(text, i) - 1;
    if (i >= nowhere - 1) return nowhere;
    ++i;
  }
  return nowhere;
}

/// Where the first element stands, or whatever stands before it and is no comment or the like.
/// `found`: asked about each of these, stops where it says so.
template <typename Found>
size_t skip_prologue(std::string_view text, const Found& found) {
  size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  for (;;) {
    at = std::min(text.find_first_not_of(xml_white_space, at), text.size());
    const std::string_view rest = text.substr(at);
    if (found(rest) || (!rest.starts_with("<!") && !rest.starts_with("<?"))) return at;
    const size_t end = end_of_special(text, at);
    if (end == nowhere) return text.size();
    at = end;
  }
}

bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 0x80;
}

}  // namespace

size_t end_of_special(std::string_view text, size_t begin) {
  const auto after = [&](std::string_view mark) {
    const size_t at = text.find(mark, begin);
    return at == nowhere ? at : at + mark.size();
  };
  const std::string_view rest = text.substr(begin);
  if (rest.starts_with("<!--")) return after("-->");
  if (rest.starts_with("<![CDATA[")) return after("]]>");
  if (rest.starts_with("<?")) return after("?>");
  if (rest.starts_with("<!DOCTYPE")) return end_of_doctype(text, begin);
  return after(">");
}

size_t end_of_tag(std::string_view text, size_t begin) {
  char quote = 0;
  for (size_t i = begin; i < text.size(); ++i) {
    if (quote ? text[i] == quote : text[i] == '"' || text[i] == '\'')
      quote = quote ? char(0) : text[i];
    else if (!quote && text[i] == '>')
      return i + 1;
  }
  return nowhere;
}

size_t find_doctype(std::string_view text) {
  const auto is_doctype = [](std::string_view rest) { return rest.starts_with("<!DOCTYPE"); };
  const size_t at = skip_prologue(text, is_doctype);
  return is_doctype(text.substr(at)) ? at : nowhere;
}

size_t end_of_name(std::string_view text, size_t begin) {
  if (begin >= text.size() || !is_name_start(text[begin])) return begin;
  size_t end = begin + 1;
  while (end < text.size() && (is_name_start(text[end]) || text[end] == '-' || text[end] == '.' ||
                               (text[end] >= '0' && text[end] <= '9')))
    ++end;
  return end;
}

std::string root_tag(std::string_view text) {
  const size_t at = skip_prologue(text, [](std::string_view) { return false; });
  if (at >= text.size() || text[at] != '<') return {};
  const size_t end = std::min(text.find_first_of(" \t\r\n/><", at + 1), text.size());
  return std::string(text.substr(at + 1, end - at - 1));
}

}  // namespace kaustik
