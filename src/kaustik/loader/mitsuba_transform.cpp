#include "kaustik/loader/mitsuba_transform.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace kaustik::mitsuba {
namespace {

const AttributeRule components_rule = {{}, {"value", "x", "y", "z"}};

Vec3d required_components(const Element& element, double absent) {
  if (!element.find("value") && !element.find("x") && !element.find("y") && !element.find("z"))
    throw BadValue(fmt::format("<{}> lacks its numbers", element.tag),
                   "give value=\"x, y, z\", or some of x=, y= and z=");
  return parse_components(element, absent);
}

/// The up vector that Mitsuba takes where none is given: the first tangent of the frame around the
/// view direction (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
Vec3d default_up(const Vec3d& origin, const Vec3d& target) {
  const Vec3d n = (target - origin).normalized();
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  return {1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

Transform parse_look_at(const Element& element) {
  const Vec3d origin = parse_attribute(*element.find("origin"), parse_vector);
  const Vec3d target = parse_attribute(*element.find("target"), parse_vector);
  Vec3d up(0, 0, 0);
  if (const Attribute* given = element.find("up")) up = parse_attribute(*given, parse_vector);
  if (up == Vec3d(0, 0, 0)) up = default_up(origin, target);
  return Transform::look_at(origin, target, up);
}

/// As before 0.3: a number in each attribute, and the picture's sides are exchanged.
Transform parse_look_at_by_numbers(const Element& element) {
  const auto vector_of = [&](char prefix, const Vec3d& otherwise) {
    Vec3d result = otherwise;
    for (const int i : {0, 1, 2})
      if (const Attribute* number = element.find(std::string{prefix, "xyz"[i]}))
        result[i] = parse_attribute(*number, parse_float);
    return result;
  };
  const Vec3d origin = vector_of('o', {0, 0, 0}), target = vector_of('t', {0, 0, 0});
  Vec3d up = vector_of('u', {0, 0, 0});
  if (up == Vec3d(0, 0, 0)) up = default_up(origin, target);
  return Transform::look_at(origin, target, up) * mirrored_camera();
}

/// Factors of zero collapse space.
Transform parse_scale(const Element& element, bool may_collapse) {
  const Vec3d s = required_components(element, 1);
  if (!may_collapse || (s.x != 0 && s.y != 0 && s.z != 0)) return Transform::scale(s);
  return Transform::collapsing({{s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}, {0, 0, 0, 1}});
}

Transform parse_matrix(std::string_view text, bool may_collapse) {
  const auto parts = split_list(text);
  if (parts.size() != 16 && parts.size() != 9)
    throw BadValue(fmt::format("the matrix has {} values", parts.size()),
                   "write 16 values (4 rows of 4) or 9 (3 rows of 3)");
  const size_t size = parts.size() == 16 ? 4 : 3;
  double rows[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  for (size_t i = 0; i < size; ++i)
    for (size_t j = 0; j < size; ++j) rows[i][j] = parse_float(parts[i * size + j]);
  const bool is_affine = rows[3][0] == 0 && rows[3][1] == 0 && rows[3][2] == 0 && rows[3][3] == 1;
  return may_collapse && is_affine ? Transform::collapsing(rows) : Transform(rows);
}

Transform parse_operation(const Element& element, bool may_collapse) {
  if (element.tag == "translate") return Transform::translate(required_components(element, 0));
  if (element.tag == "scale") return parse_scale(element, may_collapse);
  if (element.tag == "lookat" && element.find("ox")) return parse_look_at_by_numbers(element);
  if (element.tag == "lookat") return parse_look_at(element);
  if (element.tag == "matrix")
    return parse_attribute(*element.find("value"),
                           [&](std::string_view text) { return parse_matrix(text, may_collapse); });
  const Vec3d axis = required_components(element, 0);
  return Transform::rotate(axis, parse_attribute(*element.find("angle"), parse_float));
}

bool is_finite(const Transform& transform) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (!std::isfinite(transform.at(i, j))) return false;
  return true;
}

}  // namespace

AttributeRule transform_rule(const Element& element, Version version) {
  const std::string& operation = element.tag;
  if (operation == "lookat" && element.find("ox") && version < first_of_mitsuba_0_3)
    return {{"ox", "oy", "oz", "tx", "ty", "tz"}, {"ux", "uy", "uz"}};
  if (operation == "lookat") return {{"origin", "target"}, {"up"}};
  if (operation == "matrix") return {{"value"}, {}};
  if (operation == "rotate") return {{"angle"}, components_rule.optional};
  return components_rule;
}

Transform mirrored_camera() { return Transform::scale({-1, 1, 1}); }

Transform parse_transform_operation(const Element& element, bool may_collapse) {
  try {
    const Transform transform = parse_operation(element, may_collapse);
    return followed_by(Transform(), transform);
  } catch (const std::invalid_argument& wrong) {
    throw BadValue(
        fmt::format("<{}>: {}", element.tag, wrong.what()),
        element.tag == "lookat"
            ? "origin and target must differ, and up must not point from one to the other"
            : "a transform must be invertible");
  }
}

bool turns_nothing(const Element& element) {
  return element.tag == "rotate" && required_components(element, 0) == Vec3d(0, 0, 0);
}

Transform followed_by(const Transform& first, const Transform& next) {
  const auto product = [&] {
    try {
      return next * first;
    } catch (const std::invalid_argument& wrong) {
      throw BadValue(fmt::format("the transform cannot be: {}", wrong.what()),
                     "use factors other than 0 beside a projection");
    }
  };
  const Transform both = product();
  if (!is_finite(both) || !is_finite(both.inverse()))
    throw BadValue("the transform is not finite or has no finite inverse",
                   "use factors and distances of a usual size");
  return both;
}

}  // namespace kaustik::mitsuba
