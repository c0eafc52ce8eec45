#pragma once
// Of the properties of described objects.

#include <optional>
#include <string_view>
#include <utility>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Null: it has none of that name.
inline const Property* find_property(const Object& object, std::string_view name) {
  for (const Property& property : object.properties)
    if (property.name == name) return &property;
  return nullptr;
}
inline Property* find_property(Object& object, std::string_view name) {
  return const_cast<Property*>(find_property(std::as_const(object), name));
}

/// A property of that name and type; null: there is none.
template <typename T>
const T* value_in(const Object& object, std::string_view name) {
  const Property* property = find_property(object, name);
  return property ? std::get_if<T>(&property->value) : nullptr;
}

/// Of a colour, or of a number for all of its parts.
inline std::optional<Rgb> as_colour(const Value& value) {
  if (const auto* colour = std::get_if<Rgb>(&value)) return *colour;
  if (const auto* number = std::get_if<double>(&value)) return Rgb{*number, *number, *number};
  return std::nullopt;
}
/// A property that is such.
inline std::optional<Rgb> colour_in(const Object& object, std::string_view name) {
  const Property* property = find_property(object, name);
  return property ? as_colour(property->value) : std::nullopt;
}

inline void remove_property(Object& object, std::string_view name) {
  std::erase_if(object.properties, [&](const Property& p) { return p.name == name; });
}

/// Multiplies a number, 1 where it is not given.
inline void multiply_number(Object& object, const char* name, double factor) {
  Property* given = find_property(object, name);
  auto* number = given ? std::get_if<double>(&given->value) : nullptr;
  if (number)
    *number *= factor;
  else if (!given && factor != 1)
    object.properties.push_back({name, factor, object.place});
}

}  // namespace kaustik
