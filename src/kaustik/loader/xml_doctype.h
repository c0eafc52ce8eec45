#pragma once
// The DOCTYPE of an XML document: the entities that it declares.

#include <map>
#include <string>
#include <string_view>

#include "kaustik/loader/text_places.h"

namespace kaustik {

/// What `&name;` stands for.
struct Entity {
  bool is_file = false;
  std::string text;  ///< or the file's name
  size_t begin = 0;  ///< where that stands in the document
};

struct Doctype {
  std::map<std::string, Entity, std::less<>> entities;  ///< by name; of several the first
  size_t end = 0;                                       ///< of the DOCTYPE in the document
};

/// The DOCTYPE that starts at `begin`. What a file beside the document declares is not read. Throws
/// Error(input) where declarations are broken, and where parameter entities are used.
Doctype read_doctype(std::string_view document, size_t begin, const TextPlaces& places);

}  // namespace kaustik
