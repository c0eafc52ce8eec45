#include "kaustik/geometry/mesh_checks.h"

#include <fmt/format.h>

#include <cmath>

namespace kaustik {

std::optional<MeshFault> fault_of_position(uint64_t vertex, const Vec3f& p) {
  if (is_finite(p)) return std::nullopt;
  return MeshFault{fmt::format("vertex {} is not finite ({}, {}, {})", vertex, p.x, p.y, p.z),
                   "repair the mesh: all coordinates must be numbers"};
}

std::optional<MeshFault> fault_of_normal(uint64_t vertex, const Vec3f& normal) {
  if (is_finite(normal)) return std::nullopt;
  return MeshFault{fmt::format("the normal of vertex {} is not finite", vertex),
                   "export the mesh without normals, or repair them"};
}

std::optional<MeshFault> fault_of_uv(uint64_t vertex, const Vec2f& uv) {
  if (std::isfinite(uv.x) && std::isfinite(uv.y)) return std::nullopt;
  return MeshFault{fmt::format("the texture coordinate of vertex {} is not finite", vertex),
                   "export the mesh without texture coordinates, or repair them"};
}

std::optional<MeshFault> fault_of_index(uint64_t face, double index, uint64_t vertices,
                                        const char* remedy) {
  if (index >= 0 && index < double(vertices) && index == std::floor(index)) return std::nullopt;
  return MeshFault{fmt::format("face {} refers to vertex {} of {}", face, index, vertices), remedy};
}

std::optional<MeshFault> fault_of_count(uint64_t count, const std::string& name) {
  if (count < 0xffffffffull) return std::nullopt;
  return MeshFault{fmt::format("{} elements '{}' are too many", count, name),
                   "split the mesh: at most 2^32 - 2"};
}

MeshFault fault_of_no_faces() {
  return {"the mesh has no faces", "export the object as a mesh with faces"};
}

}  // namespace kaustik
