#pragma once
// The grammar of Radiance's scene files: primitives, aliases, commands, comments (ray.1 of
// Radiance).

#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik::radiance {

/// `modifier type id`, then its arguments. An alias has the type "alias" and the one string that it
/// stands for.
struct Primitive {
  std::string modifier, type, id;
  std::vector<std::string> strings;
  std::vector<double> reals;
  Place place;
};

/// What follows a '!', lines that go on joined.
struct Command {
  std::string text;
  Place place;
};

using Statement = std::variant<Primitive, Command>;
using Statements = std::vector<Statement>;

enum class Kind { surface, material, pattern, texture, mixture, alias, unknown };
/// Of a type of primitive: "polygon" is a surface.
Kind kind_of(std::string_view type);

/// Where the letter of that offset stands.
using PlaceAt = std::function<Place(size_t offset)>;

/// Throws Error(input) at what is no statement.
Statements read_statements(std::string_view text, const PlaceAt& place_at);

/// Whether text begins as scenes do: behind blanks and comments with a command, or the first two
/// words of a primitive. Nothing but comments does not.
bool begins_as_statements(std::string_view text);

/// Whether there is anything but blanks and comments.
bool holds_statements(std::string_view text);

/// "polygon 'floor.1'", for messages.
std::string name_of(const Primitive& primitive);

}  // namespace kaustik::radiance
