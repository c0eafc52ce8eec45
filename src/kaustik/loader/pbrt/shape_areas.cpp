#include "kaustik/loader/pbrt/shape_areas.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/shapes.h"

namespace kaustik::pbrt {
namespace {

/// In the world; none of what is no mesh of buffers.
std::vector<double> triangle_areas(const Object& shape, const Transform& to_world) {
  const auto mesh = buffers_of(shape);
  if (!mesh) return {};
  const auto world = [&](int32_t index) {
    const float* p = mesh->positions.data() + 3 * size_t(index);
    return Vec3d(to_world.point({p[0], p[1], p[2]}));
  };
  std::vector<double> areas;
  for (size_t i = 0; i + 2 < mesh->faces.size(); i += 3) {
    const Vec3d a = world(mesh->faces[i]);
    areas.push_back(0.5 *
                    (world(mesh->faces[i + 1]) - a).cross(world(mesh->faces[i + 2]) - a).length());
  }
  return areas;
}

}  // namespace

std::optional<double> area_of(const Object& shape) {
  const auto* given = value_in<Transform>(shape, "to_world");
  const Transform to_world = given ? *given : Transform();
  const auto vector = [&](double x, double y, double z) {
    return Vec3d(to_world.vector(Vec3f(float(x), float(y), float(z))));
  };
  const Vec3d x = vector(1, 0, 0), y = vector(0, 1, 0), z = vector(0, 0, 1);
  const double radius = number_in(shape, "radius").value_or(1);
  const auto are_alike = [](const Vec3d& a, const Vec3d& b) {
    return std::fabs(a.length() - b.length()) <= 1e-6 * a.length() &&
           std::fabs(a.dot(b)) <= 1e-6 * a.dot(a);
  };
  // Of bodies that are stretched or sheared there is no short formula.
  const bool is_round = are_alike(x, y) && (shape.type != "sphere" || are_alike(x, z)) &&
                        std::fabs(x.dot(z)) + std::fabs(y.dot(z)) <= 1e-6 * x.dot(x);
  if (!is_round && (shape.type == "sphere" || shape.type == "cylinder")) return std::nullopt;
  const double girth = radius * x.length();
  if (shape.type == "sphere") return 4 * std::numbers::pi * girth * girth;
  if (shape.type == "disk") return std::numbers::pi * x.cross(y).length();
  if (shape.type == "cylinder") {
    const auto *p0 = value_in<Vec3d>(shape, "p0"), *p1 = value_in<Vec3d>(shape, "p1");
    return p0 && p1
               ? std::optional(2 * std::numbers::pi * girth * std::fabs(p1->z - p0->z) * z.length())
               : std::nullopt;
  }
  const std::vector<double> areas = triangle_areas(shape, to_world);
  if (areas.empty()) return std::nullopt;
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

bool has_even_parts(const Object& shape, size_t parts) {
  const auto* given = value_in<Transform>(shape, "to_world");
  const std::vector<double> areas = triangle_areas(shape, given ? *given : Transform());
  if (parts == 0 || areas.size() % parts != 0) return parts <= 1;
  const size_t each = areas.size() / parts;
  double low = 0, high = 0;
  for (size_t i = 0; i < areas.size(); i += each) {
    const auto begin = areas.begin() + std::ptrdiff_t(i);
    const double area = std::accumulate(begin, begin + std::ptrdiff_t(each), 0.0);
    low = i == 0 ? area : std::min(low, area);
    high = std::max(high, area);
  }
  return high - low <= 1e-3 * high;
}

}  // namespace kaustik::pbrt
