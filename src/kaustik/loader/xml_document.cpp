#include "kaustik/loader/xml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/loader/xml_scan.h"

namespace kaustik {
namespace {

struct OpenTag {
  std::string_view name;
  size_t offset;
};

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
                       const ExpandedXml& source) {
  if (result.status != pugi::status_end_element_mismatch)
    return "correct the XML here; < and & in values are written &lt; and &amp;";
  const auto open = open_tags(text_before);
  if (open.empty()) return "no element is open here: remove the end tag";
  const Place opened = source.place(open.back().offset), here = source.place(text_before.size());
  const std::string of_file = *opened.file == *here.file ? "" : " of " + *opened.file;
  return fmt::format("<{}> of line {}{} is still open: end it with </{}>, or with '/>' at once",
                     open.back().name, opened.line, of_file, open.back().name);
}

}  // namespace

XmlDocument::XmlDocument(std::string text, std::string name, bool may_be_quoted,
                         const EntityRules& rules)
    : source_(std::move(text), std::move(name), may_be_quoted, rules),
      may_be_quoted_(may_be_quoted) {
  parse();
  check_top_level();
}

void XmlDocument::parse() {
  const std::string original = source_.xml;
  // parse_fragment shows text outside the root element, which must not pass in silence.
  const auto result =
      tree_.load_buffer_inplace(source_.xml.data(), source_.xml.size(),
                                pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
  if (result.status == pugi::status_out_of_memory)
    throw Error(ErrorKind::system, "not enough memory for the XML", {},
                Place{source_.place(0).file, 0, 0});
  if (result) return;
  const size_t offset = size_t(std::max<ptrdiff_t>(result.offset, 0));
  const std::string_view before = std::string_view(original).substr(0, offset);
  const bool in_end_tag = before.ends_with("</");
  fail(
      offset, fmt::format("broken XML: {}", result.description()),
      may_be_quoted_
          ? remedy_for(result, in_end_tag ? before.substr(0, before.size() - 2) : original, source_)
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

Place XmlDocument::place_of(const char* letter) const {
  return source_.place(size_t(letter - source_.xml.data()));
}

Place XmlDocument::place(const pugi::xml_node& node) const {
  size_t offset = size_t(std::max<ptrdiff_t>(node.offset_debug(), 0));
  if (node.type() == pugi::node_element) return source_.place(offset - 1);
  offset = std::min(source_.xml.find_first_not_of(xml_white_space, offset), source_.xml.size());
  return source_.place(offset);
}

Place XmlDocument::place_of_name(const pugi::xml_attribute& attribute) const {
  return place_of(attribute.name());
}

Place XmlDocument::place_of_value(const pugi::xml_attribute& attribute) const {
  return place_of(attribute.value());
}

void XmlDocument::fail(size_t offset, const std::string& message, const std::string& remedy) const {
  throw Error(ErrorKind::input, message, remedy, source_.place(offset));
}

}  // namespace kaustik
