#pragma once
// For readers: makes described objects.

#include <memory>
#include <string>
#include <utility>

#include "kaustik/scene/description.h"

namespace kaustik {

inline std::shared_ptr<Object> make_object(std::string family, std::string type, Place place) {
  return std::make_shared<Object>(
      Object{std::move(family), std::move(type), "", {}, {}, std::move(place)});
}

/// Gives an object a property, at the object's own place.
inline void give(Object& object, std::string name, Value value) {
  object.properties.push_back({std::move(name), std::move(value), object.place});
}
inline void give(Object& object, std::string name, const char* text) {
  give(object, std::move(name), Value(std::string(text)));
}

/// Puts an object into another one.
inline void put(Object& parent, std::string name, std::shared_ptr<Object> child) {
  parent.children.push_back({std::move(name), std::move(child)});
}

}  // namespace kaustik
