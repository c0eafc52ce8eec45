#include "kaustik/geometry/mesh_attribute.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/srgb.h"

namespace kaustik {
namespace {

Vec3f value_of(const MeshAttribute& attribute, size_t index) {
  const float* values = &attribute.values[index * size_t(attribute.components)];
  return attribute.components == 1 ? Vec3f(values[0]) : Vec3f(values[0], values[1], values[2]);
}

/// A triangle's edges from its first corner, and what is dual to them.
struct TriangleEdges {
  TriangleEdges(const TriangleMesh& mesh, const std::array<uint32_t, 3>& corner)
      : origin(mesh.positions[corner[0]]),
        u(Vec3d(mesh.positions[corner[1]]) - origin),
        v(Vec3d(mesh.positions[corner[2]]) - origin),
        normal(u.cross(v)),
        area_sq(normal.dot(normal)) {}

  /// Whose products with a vector of the plane are its parts along u and along v; zero where the
  /// triangle has no area.
  Vec3d dual_u() const { return area_sq > 0 ? v.cross(normal) / area_sq : Vec3d(0); }
  Vec3d dual_v() const { return area_sq > 0 ? normal.cross(u) / area_sq : Vec3d(0); }

  Vec3d origin, u, v, normal;
  double area_sq;  ///< of the parallelogram
};

/// What bytes stand for: scanned meshes have millions.
const std::array<float, 256>& linear_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> made{};
    for (size_t i = 0; i < made.size(); ++i) made[i] = linear_from_srgb(float(double(i) / 255));
    return made;
  }();
  return table;
}

}  // namespace

const MeshAttribute* find_attribute(const TriangleMesh& mesh, std::string_view name) {
  for (const MeshAttribute& attribute : mesh.attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

const MeshAttribute& attribute_named(const Shape& shape, const std::string& who,
                                     const std::string& name, const Place& place) {
  const TriangleMesh* mesh = shape.mesh();
  if (!mesh)
    throw Error(ErrorKind::input,
                fmt::format("{} is no mesh, so it has no attribute '{}'", who, name),
                "give it another texture, or let a mesh stand for it", place);
  if (const MeshAttribute* found = find_attribute(*mesh, name)) return *found;
  std::vector<std::string> names;
  for (const MeshAttribute& attribute : mesh->attributes) names.push_back(attribute.name);
  throw Error(ErrorKind::input, fmt::format("the mesh of {} has no attribute '{}'", who, name),
              names.empty() ? std::string("it has none at all: save it with colours, or give it "
                                          "another texture")
                            : suggest(name, names),
              place);
}

Vec3f attribute_at(const TriangleMesh& mesh, const MeshAttribute& attribute, uint32_t triangle,
                   const Vec3f& position) {
  if (attribute.is_of_faces()) return value_of(attribute, triangle);
  const auto& corner = mesh.triangles[triangle];
  const TriangleEdges edges(mesh, corner);
  const Vec3d offset = Vec3d(position) - edges.origin;
  // In this order what is no number becomes one.
  const auto share = [&](const Vec3d& dual, double most) {
    return std::min(std::max(0.0, offset.dot(dual)), most);
  };
  const double b1 = share(edges.dual_u(), 1), b2 = share(edges.dual_v(), 1 - b1);
  return value_of(attribute, corner[0]) * float(1 - b1 - b2) +
         value_of(attribute, corner[1]) * float(b1) + value_of(attribute, corner[2]) * float(b2);
}

Vec3f attribute_gradient(const TriangleMesh& mesh, const MeshAttribute& attribute,
                         uint32_t triangle, const Vec3f& weights) {
  if (attribute.is_of_faces()) return Vec3f(0);
  const auto& corner = mesh.triangles[triangle];
  const TriangleEdges edges(mesh, corner);
  const auto at = [&](size_t i) { return double(dot(value_of(attribute, corner[i]), weights)); };
  return Vec3f(edges.dual_u() * (at(1) - at(0)) + edges.dual_v() * (at(2) - at(0)));
}

Vec3f attribute_mean(const TriangleMesh& mesh, const MeshAttribute& attribute) {
  Vec3d sum(0);
  double area = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& corner = mesh.triangles[i];
    const double own = std::sqrt(TriangleEdges(mesh, corner).area_sq);
    const Vec3d mean = attribute.is_of_faces() ? Vec3d(value_of(attribute, i))
                                               : (Vec3d(value_of(attribute, corner[0])) +
                                                  Vec3d(value_of(attribute, corner[1])) +
                                                  Vec3d(value_of(attribute, corner[2]))) /
                                                     3.0;
    sum += mean * own;
    area += own;
  }
  return area > 0 ? Vec3f(sum / area) : Vec3f(0);
}

float attribute_maximum(const MeshAttribute& attribute) {
  const auto largest = std::max_element(attribute.values.begin(), attribute.values.end());
  return largest == attribute.values.end() ? 0 : *largest;
}

float attribute_value(double stored, double largest) {
  if (!(largest > 0)) return float(stored);
  if (largest == 255 && stored >= 0 && stored <= 255 && stored == std::floor(stored))
    return linear_bytes()[size_t(stored)];
  return linear_from_srgb(float(stored / largest));
}

size_t make_finite(MeshAttribute& attribute) {
  size_t count = 0;
  for (float& value : attribute.values)
    if (!std::isfinite(value)) {
      value = 0;
      ++count;
    }
  return count;
}

std::string remark_on_attribute(const std::string& name, size_t count, const std::string& file) {
  const bool is_one = count == 1;
  return fmt::format("{}: {} value{} of '{}' {} not finite: taken as 0", file, count,
                     is_one ? "" : "s", name, is_one ? "is" : "are");
}

}  // namespace kaustik
