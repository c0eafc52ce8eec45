#include "kaustik/loader/pbrt/surface_mapping.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/shapes.h"

namespace kaustik::pbrt {
namespace {

constexpr double turn = 2 * std::numbers::pi;

void replace_floats(Object& shape, const char* name, std::vector<float> numbers, size_t columns) {
  const size_t rows = numbers.size() / columns;
  remove_property(shape, name);
  set(shape, name, Value(Array::of<float>({rows, columns}, std::move(numbers))));
}

void append_row(std::vector<float>& numbers, size_t row, size_t columns) {
  for (size_t i = 0; i < columns; ++i) numbers.push_back(numbers[row * columns + i]);
}

/// The parts of a mesh whose angles begin anew within faces.
class SeamSplitter {
 public:
  /// `axis`: of uv, that is the angle.
  SeamSplitter(MeshParts mesh, size_t axis)
      : mesh_(std::move(mesh)), axis_(axis), beyond_(mesh_.positions.size() / 3, -1) {}

  MeshParts split() {
    for (size_t face = 0; face + 2 < mesh_.faces.size(); face += 3) {
      int32_t* const corners = mesh_.faces.data() + face;
      const auto [low, high] =
          std::minmax({angle(corners[0]), angle(corners[1]), angle(corners[2])});
      if (high - low <= 0.5f) continue;
      for (size_t i = 0; i < 3; ++i)
        if (angle(corners[i]) < 0.5f) corners[i] = doubled(corners[i]);
    }
    return std::move(mesh_);
  }

 private:
  float& angle(int32_t vertex) { return mesh_.uv[2 * size_t(vertex) + axis_]; }
  /// The vertex at the same place a turn later.
  int32_t doubled(int32_t vertex) {
    int32_t& other = beyond_[size_t(vertex)];
    if (other >= 0) return other;
    other = int32_t(mesh_.positions.size() / 3);
    append_row(mesh_.positions, size_t(vertex), 3);
    if (!mesh_.normals.empty()) append_row(mesh_.normals, size_t(vertex), 3);
    append_row(mesh_.uv, size_t(vertex), 2);
    angle(other) += 1;
    return other;
  }

  MeshParts mesh_;
  size_t axis_;
  std::vector<int32_t> beyond_;  ///< of vertices; −1: none
};

}  // namespace

std::optional<MappingKind> mapping_kind_named(std::string_view name) {
  if (name == "planar") return MappingKind::planar;
  if (name == "spherical") return MappingKind::spherical;
  if (name == "cylindrical") return MappingKind::cylindrical;
  return std::nullopt;
}

std::array<double, 2> uv_at(const SurfaceMapping& mapping, const Vec3d& p) {
  const double angle = std::atan2(p.y, p.x);
  switch (mapping.kind) {
    case MappingKind::planar:
      return {mapping.delta_u + p.dot(mapping.along_u), mapping.delta_v + p.dot(mapping.along_v)};
    case MappingKind::spherical:
      return {std::atan2(std::hypot(p.x, p.y), p.z) / std::numbers::pi,
              (angle < 0 ? angle + turn : angle) / turn};
    case MappingKind::cylindrical:
      return {0.5 + angle / turn, p.z};
  }
  return {0, 0};
}

bool lay_by(const SurfaceMapping& mapping, Object& shape) {
  const auto mesh = buffers_of(shape);
  if (!mesh || mapping.world_from_texture.dimensions() < 3) return false;
  const auto* to_world = value_in<Transform>(shape, "to_world");
  Transform texture_from_mesh = mapping.world_from_texture.inverse();
  if (to_world) texture_from_mesh = texture_from_mesh * *to_world;
  std::vector<float> uv;
  uv.reserve(mesh->positions.size() / 3 * 2);
  for (size_t i = 0; i + 2 < mesh->positions.size(); i += 3) {
    const float* const p = mesh->positions.data() + i;
    constexpr double most = 1e12;
    for (const double coordinate :
         uv_at(mapping, Vec3d(texture_from_mesh.point({p[0], p[1], p[2]}))))
      uv.push_back(float(std::clamp(coordinate, -most, most)));
  }
  if (mapping.kind == MappingKind::planar) {
    replace_floats(shape, "uv", std::move(uv), 2);
    return true;
  }
  const auto copy = [](auto numbers) { return std::vector(numbers.begin(), numbers.end()); };
  MeshParts parts{copy(mesh->positions), copy(mesh->normals), std::move(uv), copy(mesh->faces)};
  const size_t faces = parts.faces.size() / 3;
  parts = SeamSplitter(std::move(parts), mapping.kind == MappingKind::spherical ? 1 : 0).split();
  replace_floats(shape, "positions", std::move(parts.positions), 3);
  if (!parts.normals.empty()) replace_floats(shape, "normals", std::move(parts.normals), 3);
  replace_floats(shape, "uv", std::move(parts.uv), 2);
  remove_property(shape, "faces");
  set(shape, "faces", Value(Array::of<int32_t>({faces, 3}, std::move(parts.faces))));
  return true;
}

size_t SurfaceMappings::index_of(SurfaceMapping mapping) {
  std::vector<double> key = {double(mapping.kind), mapping.delta_u, mapping.delta_v};
  for (const Vec3d& v : {mapping.along_u, mapping.along_v}) key.insert(key.end(), {v.x, v.y, v.z});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      key.push_back(mapping.world_from_texture.at(row, column));
  const auto [entry, is_new] = known_.try_emplace(std::move(key), all_.size() + 1);
  if (is_new) all_.push_back(std::move(mapping));
  return entry->second;
}

}  // namespace kaustik::pbrt
