#include "kaustik/loader/xml_document.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

constexpr std::string_view white_space = " \t\r\n";
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/// Length of the UTF-8 sequence (RFC 3629) at the start of `text`, 0 if there is none.
size_t utf8_length(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Overlong forms, surrogates, and what lies above U+10FFFF.
  if (first == 0xe0 && byte(1) < 0xa0) return 0;
  if (first == 0xed && byte(1) > 0x9f) return 0;
  if (first == 0xf0 && byte(1) < 0x90) return 0;
  if (first == 0xf4 && byte(1) > 0x8f) return 0;
  return length;
}

struct OpenTag {
  std::string_view name;
  size_t offset;
};

/// The end of a comment or the like that starts at `begin`; npos if it does not end.
size_t end_of_special(std::string_view text, size_t begin) {
  const auto after = [&](std::string_view mark) {
    const size_t at = text.find(mark, begin);
    return at == std::string_view::npos ? at : at + mark.size();
  };
  const std::string_view rest = text.substr(begin);
  if (rest.starts_with("<!--")) return after("-->");
  if (rest.starts_with("<![CDATA[")) return after("]]>");
  if (rest.starts_with("<?")) return after("?>");
  return after(">");
}

/// The end of the tag that starts at `begin`: quoted text may hold a '>'.
size_t end_of_tag(std::string_view text, size_t begin) {
  char quote = 0;
  for (size_t i = begin; i < text.size(); ++i) {
    if (quote ? text[i] == quote : text[i] == '"' || text[i] == '\'')
      quote = quote ? char(0) : text[i];
    else if (!quote && text[i] == '>')
      return i + 1;
  }
  return std::string_view::npos;
}

/// Elements that are open where `text` ends, outermost first; for messages only.
std::vector<OpenTag> open_tags(std::string_view text) {
  std::vector<OpenTag> open;
  size_t at = text.find('<');
  while (at != std::string_view::npos && at + 1 < text.size()) {
    const bool special = text[at + 1] == '!' || text[at + 1] == '?';
    const size_t end = special ? end_of_special(text, at) : end_of_tag(text, at);
    if (end == std::string_view::npos) break;
    if (text[at + 1] == '/') {
      if (!open.empty()) open.pop_back();
    } else if (!special && text[end - 2] != '/') {
      const size_t name_end = text.find_first_of(" \t\r\n/>", at + 1);
      open.push_back({text.substr(at + 1, name_end - at - 1), at});
    }
    at = text.find('<', end);
  }
  return open;
}

/// "Start-end tags mismatch" tells little without the tag that is still open.
std::string remedy_for(const pugi::xml_parse_result& result, std::string_view text_before,
                       const std::vector<size_t>& line_starts) {
  if (result.status != pugi::status_end_element_mismatch)
    return "correct the XML here; < and & in values are written &lt; and &amp;";
  const auto open = open_tags(text_before);
  if (open.empty()) return "no element is open here: remove the end tag";
  const auto next_line =
      std::upper_bound(line_starts.begin(), line_starts.end(), open.back().offset);
  return fmt::format("<{}> of line {} is still open: end it with </{}>, or with '/>' at once",
                     open.back().name, next_line - line_starts.begin(), open.back().name);
}

}  // namespace

XmlDocument::XmlDocument(std::string text, std::string name, bool may_be_quoted)
    : name_(std::make_shared<const std::string>(std::move(name))),
      text_(std::move(text)),
      may_be_quoted_(may_be_quoted) {
  if (text_.starts_with(byte_order_mark)) text_.erase(0, byte_order_mark.size());
  line_starts_.push_back(0);
  for (size_t i = 0; i < text_.size(); ++i)
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
  check_encoding();
  parse();
  check_top_level();
}

void XmlDocument::check_encoding() const {
  if (text_.starts_with("\xff\xfe") || text_.starts_with("\xfe\xff"))
    fail(0, "the file is UTF-16 text", "save it as UTF-8");
  for (size_t i = 0; i < text_.size();) {
    if (text_[i] == 0)
      fail(i, "a zero byte: this is not XML text", "give a Mitsuba XML scene, saved as UTF-8");
    const size_t length = utf8_length(std::string_view(text_).substr(i));
    if (length == 0) fail(i, "a byte that is not UTF-8", "save the file as UTF-8");
    i += length;
  }
}

void XmlDocument::parse() {
  const std::string original = text_;
  // parse_fragment shows text outside the root element, which must not pass in silence.
  const auto result = tree_.load_buffer_inplace(
      text_.data(), text_.size(), pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
  if (result.status == pugi::status_out_of_memory)
    throw Error(ErrorKind::system, "not enough memory for the XML", {}, Place{name_, 0, 0});
  if (result) return;
  const size_t offset = size_t(std::max<ptrdiff_t>(result.offset, 0));
  const std::string_view before = std::string_view(original).substr(0, offset);
  const bool in_end_tag = before.ends_with("</");
  fail(offset, fmt::format("broken XML: {}", result.description()),
       may_be_quoted_
           ? remedy_for(result, in_end_tag ? before.substr(0, before.size() - 2) : original,
                        line_starts_)
           : "give a Mitsuba scene, which is XML in UTF-8");
}

void XmlDocument::check_top_level() const {
  const pugi::xml_node root_node = root();
  for (const pugi::xml_node& node : tree_.children()) {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
      const Place where = place(node);
      throw Error(ErrorKind::input, "broken XML: text outside the root element",
                  "put <scene version=\"3.0.0\"> … </scene> around everything", where);
    }
    if (node.type() == pugi::node_element && node != root_node)
      throw Error(ErrorKind::input, "broken XML: a second root element",
                  "put everything into one <scene>", place(node));
  }
  if (!root_node)
    fail(0, "the file holds no XML element", "a scene starts with <scene version=\"3.0.0\">");
}

Place XmlDocument::place_at(size_t offset) const {
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const auto line = next - line_starts_.begin();
  return {name_, int(line), may_be_quoted_ ? int(offset - *(next - 1)) + 1 : 0};
}

Place XmlDocument::place_of(const char* letter) const {
  return place_at(size_t(letter - text_.data()));
}

Place XmlDocument::place(const pugi::xml_node& node) const {
  size_t offset = size_t(std::max<ptrdiff_t>(node.offset_debug(), 0));
  if (node.type() == pugi::node_element) return place_at(offset - 1);
  offset = std::min(text_.find_first_not_of(white_space, offset), text_.size());
  return place_at(offset);
}

Place XmlDocument::place_of_name(const pugi::xml_attribute& attribute) const {
  return place_of(attribute.name());
}

Place XmlDocument::place_of_value(const pugi::xml_attribute& attribute) const {
  return place_of(attribute.value());
}

void XmlDocument::fail(size_t offset, const std::string& message, const std::string& remedy) const {
  throw Error(ErrorKind::input, message, remedy, place_at(offset));
}

std::string root_tag(std::string_view text) {
  size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  for (;;) {
    at = std::min(text.find_first_not_of(white_space, at), text.size());
    const std::string_view rest = text.substr(at);
    if (!rest.starts_with("<!") && !rest.starts_with("<?")) break;
    const size_t end = end_of_special(text, at);
    if (end == std::string_view::npos) return {};
    at = end;
  }
  if (at >= text.size() || text[at] != '<') return {};
  const size_t end = std::min(text.find_first_of(" \t\r\n/><", at + 1), text.size());
  return std::string(text.substr(at + 1, end - at - 1));
}

}  // namespace kaustik
