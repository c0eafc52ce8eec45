#pragma once
#include <pugixml.hpp>
#include <string>

#include "kaustik/base/place.h"
#include "kaustik/loader/xml_entities.h"

namespace kaustik {

/// An XML text, parsed, in which every node and attribute knows its place.
class XmlDocument {
 public:
  /// Throws Error(input) unless `text` is well-formed XML in UTF-8 (a byte order mark is allowed)
  /// with one root element, after its entities are replaced. `name` stands for the file in
  /// messages. Unless it may be quoted, places have no column, so that no error shows an excerpt.
  XmlDocument(std::string text, std::string name, bool may_be_quoted = true,
              const EntityRules& rules = {});
  XmlDocument(const XmlDocument&) = delete;
  XmlDocument& operator=(const XmlDocument&) = delete;

  pugi::xml_node root() const { return tree_.document_element(); }
  /// Of the '<' of an element, of the first letter of a text.
  Place place(const pugi::xml_node& node) const;
  Place place_of_name(const pugi::xml_attribute& attribute) const;
  /// Of the first letter after the quote.
  Place place_of_value(const pugi::xml_attribute& attribute) const;

 private:
  Place place_of(const char* letter) const;
  void parse();
  void check_top_level() const;
  [[noreturn]] void fail(size_t offset, const std::string& message,
                         const std::string& remedy) const;

  ExpandedXml source_;  ///< its text is parsed in place: it holds the strings of the tree
  bool may_be_quoted_;
  pugi::xml_document tree_;
};

}  // namespace kaustik
