#pragma once
// Short ways to describe objects.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik::radiance {

using ObjectPointer = std::shared_ptr<Object>;

inline ObjectPointer make_object(std::string family, std::string type, const Place& place) {
  return std::make_shared<Object>(Object{std::move(family), std::move(type), "", {}, {}, place});
}
inline void give(Object& object, std::string name, Value value) {
  object.properties.push_back({std::move(name), std::move(value), object.place});
}
inline void nest(Object& object, ObjectPointer child, std::string name = {}) {
  object.children.push_back({std::move(name), std::move(child)});
}

}  // namespace kaustik::radiance
