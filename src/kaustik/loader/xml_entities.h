#pragma once
// Entities of XML: what the DOCTYPE of a document declares `&name;` to stand for.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/place.h"
#include "kaustik/loader/text_places.h"

namespace kaustik {

/// A file that an entity stands for; its text may be quoted in messages.
struct EntityFile {
  std::string text, name;
};

/// What a document may read and use up for its entities.
struct EntityRules {
  /// Reads the file of that name, as it is declared at `place`. Throws Error. Empty: none may be
  /// read.
  std::function<EntityFile(const std::string& name, const Place& place)> read;
  /// Of the texts that entities are replaced by, in all documents of a scene. Null: `most_bytes`
  /// for this document alone.
  size_t* bytes_left = nullptr;

  /// Entities that hold entities grow fast.
  static constexpr size_t most_bytes = size_t{16} << 20;
  static constexpr size_t most_levels = 15;
};

/// An XML text with each `&name;` replaced by what a DOCTYPE in it declares, in elements and in
/// the values of attributes, and the places where all of it was written. The five that XML itself
/// declares stay, and so do all where nothing is declared or nothing may be quoted.
class ExpandedXml {
 public:
  /// `name` stands for the file in messages. Throws Error(input) at the place of what is wrong:
  /// text that is not UTF-8, declarations that do not end, names that are not declared, entities
  /// within themselves, beyond `rules`, or of files in attributes.
  ExpandedXml(std::string written, std::string name, bool may_be_quoted, const EntityRules& rules);

  std::string xml;
  /// Of a letter of it.
  Place place(size_t offset) const;

 private:
  class Expander;
  /// From this offset on the text is that of a source, from that offset of it on.
  struct Piece {
    size_t begin, source, offset;
  };
  std::vector<TextPlaces> sources_;  ///< the document itself is the first
  std::vector<Piece> pieces_;        ///< the first begins at 0
};

}  // namespace kaustik
