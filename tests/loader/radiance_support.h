#pragma once
// What the tests of Radiance's scenes share.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/radiance/radiance_scene.h"
#include "loader_support.h"

namespace kaustik::radiance_test {

inline constexpr double pi_d = std::numbers::pi;

inline Description parse_rad(const std::string& text, const LoadOptions& options = {}) {
  return parse_radiance(text, "test.rad", "", options);
}

/// Scenes that nothing lights get light of the reader's own, which is of no interest here.
inline bool is_in_studio(const Description& description) {
  return std::any_of(description.deviations.begin(), description.deviations.end(),
                     [](const Deviation& deviation) { return deviation.object == "light"; });
}

inline std::vector<const Object*> rad_objects(const Description& description,
                                              const std::string& family) {
  std::vector<const Object*> found;
  const bool is_studio = is_in_studio(description);
  for (const Child& child : description.scene->children) {
    const Object& object = *child.object;
    if (object.family != family) continue;
    if (is_studio && (object.type == "rectangle" || object.type == "constant")) continue;
    found.push_back(&object);
  }
  return found;
}
/// The only one.
inline const Object& sole_object(const Description& description, const std::string& family) {
  const auto found = rad_objects(description, family);
  if (found.size() != 1)
    throw std::runtime_error(std::to_string(found.size()) + " objects of " + family);
  return *found[0];
}
/// The child of that family, and of that name unless it is "".
inline const Object& nested(const Object& object, const std::string& family,
                            const std::string& name = {}) {
  for (const Child& child : object.children)
    if (child.object->family == family && (name.empty() || child.name == name))
      return *child.object;
  throw std::runtime_error("no " + family + " in " + object.type);
}
/// Of a material behind `twosided`.
inline const Object& front_bsdf(const Object& shape) {
  const Object& bsdf = nested(shape, "bsdf");
  return bsdf.type == "twosided" ? nested(bsdf, "bsdf") : bsdf;
}

inline std::vector<double> rad_numbers(const Object& object, const std::string& name) {
  const auto& array = *value<std::shared_ptr<const Array>>(object, name);
  return array.visit([](auto values) { return std::vector<double>(values.begin(), values.end()); });
}

/// The triangles of a mesh, three corners each.
inline std::vector<Vec3d> triangles_of(const Object& mesh) {
  const auto positions = rad_numbers(mesh, "positions"), faces = rad_numbers(mesh, "faces");
  std::vector<Vec3d> corners;
  for (const double face : faces) {
    const size_t i = 3 * size_t(face);
    corners.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  }
  return corners;
}
/// Areas of all triangles along their normals, added.
inline Vec3d area_vector_of(const Object& mesh) {
  const auto t = triangles_of(mesh);
  Vec3d sum(0, 0, 0);
  for (size_t i = 0; i < t.size(); i += 3) sum += (t[i + 1] - t[i]).cross(t[i + 2] - t[i]) * 0.5;
  return sum;
}
inline double area_of(const Object& mesh) {
  const auto t = triangles_of(mesh);
  double sum = 0;
  for (size_t i = 0; i < t.size(); i += 3)
    sum += (t[i + 1] - t[i]).cross(t[i + 2] - t[i]).length() / 2;
  return sum;
}
/// Of a closed mesh that faces outward.
inline double volume_of(const Object& mesh) {
  const auto t = triangles_of(mesh);
  double sum = 0;
  for (size_t i = 0; i < t.size(); i += 3) sum += t[i].dot(t[i + 1].cross(t[i + 2])) / 6;
  return sum;
}

/// Whether something of that kind was told of an object whose name holds a text.
inline bool tells(const Description& description, DeviationKind kind, const std::string& object,
                  const std::string& what = {}) {
  for (const Deviation& deviation : description.deviations)
    if (deviation.kind == kind && deviation.object.find(object) != std::string::npos &&
        deviation.what.find(what) != std::string::npos)
      return true;
  return false;
}
/// What is told beside the camera and the light that scenes without one get.
inline size_t deviations_but_view(const Description& description) {
  size_t count = 0;
  for (const Deviation& deviation : description.deviations)
    if (deviation.object != "camera" && deviation.object != "light") ++count;
  return count;
}

inline const std::string grey = "void plastic grey 0 0 5 .5 .5 .5 0 0\n";
inline const std::string square = "grey polygon floor 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n";

/// A material on a square.
inline Description with_material(const std::string& material) {
  return parse_rad(material + "\nm polygon p 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n");
}

inline void expect_colour(const Object& object, const std::string& name, double r, double g,
                          double b, double tolerance = 1e-9) {
  const auto colour = colour_in(object, name);
  ASSERT_TRUE(colour) << name;
  EXPECT_NEAR(colour->r, r, tolerance) << name;
  EXPECT_NEAR(colour->g, g, tolerance) << name;
  EXPECT_NEAR(colour->b, b, tolerance) << name;
}

}  // namespace kaustik::radiance_test
