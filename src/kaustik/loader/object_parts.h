#pragma once
// Of the properties of described objects.

#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>
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

/// A property of that name and type; null: there is none. Numbers have number_in(), since files
/// give them as integers, too.
template <typename T>
const T* value_in(const Object& object, std::string_view name) {
  static_assert(!std::is_same_v<T, double>);
  const Property* property = find_property(object, name);
  return property ? std::get_if<T>(&property->value) : nullptr;
}

/// Of a number, also of one that is given as an integer.
inline std::optional<double> as_number(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* integer = std::get_if<int64_t>(&value)) return double(*integer);
  return std::nullopt;
}
/// A property that is such.
inline std::optional<double> number_in(const Object& object, std::string_view name) {
  const Property* property = find_property(object, name);
  return property ? as_number(property->value) : std::nullopt;
}

/// Of a colour, or of a number for all of its parts.
inline std::optional<Rgb> as_colour(const Value& value) {
  if (const auto* colour = std::get_if<Rgb>(&value)) return *colour;
  if (const auto number = as_number(value)) return Rgb{*number, *number, *number};
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

/// Puts another number in place of each one of a number, a colour or a curve; what is none of these
/// stays.
template <typename Function>
void change_numbers(Value& value, const Function& other) {
  if (const auto number = as_number(value)) value = other(*number);
  if (auto* colour = std::get_if<Rgb>(&value))
    *colour = {other(colour->r), other(colour->g), other(colour->b)};
  if (auto* curve = std::get_if<SpectralCurve>(&value))
    for (auto& sample : curve->samples) sample.second = other(sample.second);
}
inline void multiply_value(Value& value, double factor) {
  change_numbers(value, [&](double number) { return number * factor; });
}

/// Multiplies a number, 1 where it is not given.
inline void multiply_number(Object& object, const char* name, double factor) {
  Property* given = find_property(object, name);
  if (given && as_number(given->value))
    multiply_value(given->value, factor);
  else if (!given && factor != 1)
    object.properties.push_back({name, factor, object.place});
}

}  // namespace kaustik
