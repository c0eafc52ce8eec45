#pragma once
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik {

/// An XML text, parsed, in which every node and attribute knows its place.
class XmlDocument {
 public:
  /// Throws Error(input) unless `text` is well-formed XML in UTF-8 (a byte order mark is allowed)
  /// with one root element. `name` stands for the file in messages. Unless it may be quoted, places
  /// have no column, so that no error shows an excerpt.
  XmlDocument(std::string text, std::string name, bool may_be_quoted = true);
  XmlDocument(const XmlDocument&) = delete;
  XmlDocument& operator=(const XmlDocument&) = delete;

  pugi::xml_node root() const { return tree_.document_element(); }
  /// Of the '<' of an element, of the first letter of a text.
  Place place(const pugi::xml_node& node) const;
  Place place_of_name(const pugi::xml_attribute& attribute) const;
  /// Of the first letter after the quote.
  Place place_of_value(const pugi::xml_attribute& attribute) const;

 private:
  Place place_at(size_t offset) const;
  Place place_of(const char* letter) const;
  void check_encoding() const;
  void parse();
  void check_top_level() const;
  [[noreturn]] void fail(size_t offset, const std::string& message,
                         const std::string& remedy) const;

  std::shared_ptr<const std::string> name_;
  std::string text_;  ///< parsed in place: holds the strings of the tree
  std::vector<size_t> line_starts_;
  bool may_be_quoted_;
  pugi::xml_document tree_;
};

/// The tag of the first element, which may be all that is sound; "" if something else comes first.
std::string root_tag(std::string_view text);

}  // namespace kaustik
