#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace kaustik {

/// Properties of a mesh file that make up one attribute.
struct AttributeGroup {
  std::string name;             ///< without what has it: "color", "heat", "paint_color"
  std::vector<size_t> members;  ///< one property, or three
};

/// The attributes among the properties of an element ("" for those that cannot be part of any), by
/// Mitsuba's rules: r, g and b, or red, green and blue, are "color"; others go together if they
/// stand side by side, begin with the same words, and end with _x _y _z, _r _g _b, _0 _1 _2 or
/// _1 _2 _3, of which the first alone is a number. Those with _r are called …_color. A fourth
/// member, opacity, is left out.
std::vector<AttributeGroup> attribute_groups(const std::vector<std::string>& properties);

}  // namespace kaustik
