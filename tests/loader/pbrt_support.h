#pragma once
// What the tests of pbrt's reader share.

#include "kaustik/loader/pbrt_scene.h"
#include "tests/loader/loader_support.h"

namespace kaustik::pbrt {

inline Description parse_scene_of_pbrt(const std::string& text, bool is_strict = false,
                                       const std::string& folder = "") {
  LoadOptions options;
  options.is_strict = is_strict;
  return parse_pbrt(text, "test.pbrt", folder, options);
}

/// Objects of a family at the top of the scene.
inline std::vector<std::shared_ptr<Object>> objects_of(const Description& description,
                                                       const std::string& family) {
  std::vector<std::shared_ptr<Object>> found;
  for (const Child& child : description.scene->children)
    if (child.object->family == family) found.push_back(child.object);
  return found;
}

/// The only one of a family in the scene or in an object.
inline const Object& only(const Object& parent, const std::string& family) {
  const Object* found = nullptr;
  for (const Child& child : parent.children)
    if (child.object->family == family) {
      if (found) throw std::runtime_error("a second " + family);
      found = child.object.get();
    }
  if (!found) throw std::runtime_error("no " + family);
  return *found;
}
inline const Object& only(const Description& description, const std::string& family) {
  return only(*description.scene, family);
}

inline const Object& child(const Object& parent, const std::string& name) {
  for (const Child& part : parent.children)
    if (part.name == name) return *part.object;
  throw std::runtime_error("no child " + name);
}

/// Within 'twosided'.
inline const Object& one_sided(const Object& bsdf) {
  EXPECT_EQ(bsdf.type, "twosided");
  return only(bsdf, "bsdf");
}

/// The bsdf of a sphere with these lines before it.
inline std::shared_ptr<Object> bsdf_of(const Description& description) {
  for (const auto& shape : objects_of(description, "shape"))
    for (const Child& part : shape->children)
      if (part.object->family == "bsdf") return part.object;
  throw std::runtime_error("no bsdf");
}
inline std::shared_ptr<Object> material(const std::string& lines) {
  return bsdf_of(parse_scene_of_pbrt("WorldBegin\n" + lines + "\nShape \"sphere\"\n"));
}

/// Whether something was told of the kind, whose object and sentence hold these texts.
inline bool is_told(const Description& description, DeviationKind kind, const std::string& object,
                    const std::string& what) {
  for (const Deviation& deviation : description.deviations)
    if (deviation.kind == kind && deviation.object.find(object) != std::string::npos &&
        deviation.what.find(what) != std::string::npos)
      return deviation.place.file != nullptr;
  return false;
}
inline bool is_approximated(const Description& d, const std::string& object,
                            const std::string& what) {
  return is_told(d, DeviationKind::approximated, object, what);
}
inline bool is_ignored(const Description& d, const std::string& object, const std::string& what) {
  return is_told(d, DeviationKind::ignored, object, what);
}
inline bool is_missing(const Description& d, const std::string& object, const std::string& what) {
  return is_told(d, DeviationKind::missing, object, what);
}

inline void expect_rgb(const Rgb& colour, double r, double g, double b, double tolerance = 1e-9) {
  EXPECT_NEAR(colour.r, r, tolerance);
  EXPECT_NEAR(colour.g, g, tolerance);
  EXPECT_NEAR(colour.b, b, tolerance);
}

inline void expect_same(const Transform& a, const Transform& b, double tolerance = 1e-6) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_NEAR(a.at(row, column), b.at(row, column), tolerance) << row << ", " << column;
}

template <typename T>
std::vector<T> numbers_in(const Object& object, const std::string& name) {
  std::vector<T> numbers;
  value<std::shared_ptr<const Array>>(object, name)->visit([&](auto values) {
    for (const auto v : values) numbers.push_back(T(v));
  });
  return numbers;
}

}  // namespace kaustik::pbrt
