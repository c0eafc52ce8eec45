#pragma once
// What is in force at a place of a file: AttributeBegin and AttributeEnd keep and restore it.

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/loader/pbrt/materials.h"

namespace kaustik::pbrt {

/// The two transforms of a motion, at its start and its end.
struct MovingTransform {
  Transform start, end;
  bool is_moving = false;  ///< whether they were changed apart
};

/// What the directive Attribute gives to objects that follow.
enum class AttributeKind : uint8_t { shape, light, material, medium, texture };
inline constexpr size_t attribute_kinds = 5;

/// AreaLightSource, for shapes that follow.
struct AreaLight {
  std::string type;
  ParameterList parameters;
  ColourSpace space = ColourSpace::srgb;
};

/// Names of media on both sides of surfaces; "": empty space.
struct MediumSides {
  std::string inside, outside;
  bool is_given = false;
  Place place;

  friend bool operator==(const MediumSides& a, const MediumSides& b) {
    return a.inside == b.inside && a.outside == b.outside && a.is_given == b.is_given;
  }
};

struct GraphicsState {
  MovingTransform transform;
  bool changes_start = true, changes_end = true;  ///< ActiveTransform
  MaterialReference material;
  std::shared_ptr<const AreaLight> area_light;  ///< null: none
  MediumSides media;
  bool reverses_orientation = false;
  ColourSpace colour_space = ColourSpace::srgb;
  /// Null: none.
  std::array<std::shared_ptr<const ParameterList>, attribute_kinds> attributes;
};

}  // namespace kaustik::pbrt
