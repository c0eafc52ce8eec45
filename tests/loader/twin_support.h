#pragma once
// Compares the descriptions of scenes that two readers made.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "kaustik/loader/object_parts.h"
#include "kaustik/scene/description.h"

namespace kaustik::twins {

/// What a property is where none is given; of others there is no usual one.
inline Value usual(const std::string& name) {
  if (name == "to_world") return Transform();
  if (name == "reflectance") return 0.5;
  if (name == "radius") return 1.0;
  return std::string("not given");
}

inline Value value_of(const Object& object, const std::string& name) {
  const Property* property = find_property(object, name);
  return property ? property->value : usual(name);
}

inline bool agrees(const std::string& name, const Value& a, const Value& b) {
  constexpr double tolerance = 1e-6;
  const auto near = [](double x, double y) { return std::fabs(x - y) < tolerance; };
  if (const auto* s = std::get_if<Transform>(&a), *t = std::get_if<Transform>(&b); s && t) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        if (!near(s->at(i, j), t->at(i, j))) return false;
    return true;
  }
  if (const auto* s = std::get_if<Vec3d>(&a), *t = std::get_if<Vec3d>(&b); s && t)
    return name == "direction" ? (s->normalized() - t->normalized()).length() < tolerance
                               : (*s - *t).length() < tolerance;
  const auto x = as_colour(a), y = as_colour(b);
  if (x && y) return near(x->r, y->r) && near(x->g, y->g) && near(x->b, y->b);
  return a == b;
}

/// How many differences there are; each is a failure where they are not expected.
inline int differences(const Object& a, const Object& b, bool is_expected,
                       const std::string& path = "") {
  int count = 0;
  const auto check = [&](bool is_same, const std::string& what) {
    if (is_same) return;
    ++count;
    if (!is_expected) ADD_FAILURE() << path << a.family << " '" << a.type << "': " << what;
  };
  check(a.family == b.family && a.type == b.type, "the other is a " + b.family + " " + b.type);
  std::set<std::string> names;
  for (const Object* object : {&a, &b})
    for (const Property& property : object->properties) names.insert(property.name);
  for (const std::string& name : names)
    check(agrees(name, value_of(a, name), value_of(b, name)), name);
  check(a.children.size() == b.children.size(), "children");
  for (size_t i = 0; i < std::min(a.children.size(), b.children.size()); ++i) {
    check(a.children[i].name == b.children[i].name, "names of children");
    count +=
        differences(*a.children[i].object, *b.children[i].object, is_expected, path + a.type + "/");
  }
  return count;
}

}  // namespace kaustik::twins
