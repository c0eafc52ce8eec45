#pragma once
// Small steps in making objects of a description.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "kaustik/scene/description.h"

namespace kaustik::pbrt {

inline std::shared_ptr<Object> described(const char* family, const char* type, const Place& place) {
  return std::make_shared<Object>(Object{family, type, "", {}, {}, place});
}

inline void set(Object& object, const char* name, Value value) {
  object.properties.push_back({name, std::move(value), object.place});
}

inline void hold(Object& object, const char* name, std::shared_ptr<Object> child) {
  object.children.push_back({name, std::move(child)});
}

/// A value, or a texture that stands for it; neither: nothing was given.
struct Input {
  std::optional<Value> value;
  std::shared_ptr<Object> texture;

  bool is_given() const { return value || texture; }
};

inline void set(Object& object, const char* name, const Input& input) {
  if (input.texture)
    hold(object, name, input.texture);
  else if (input.value)
    set(object, name, *input.value);
}

}  // namespace kaustik::pbrt
