// The part of SceneReader and SurfaceMaker that places octrees and compiled meshes.

#include <fmt/format.h>

#include <map>
#include <set>
#include <span>

#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/placement.h"
#include "kaustik/loader/radiance/reader.h"
#include "kaustik/loader/radiance/surface_parts.h"
#include "kaustik/loader/radiance/texture_coordinates.h"

namespace kaustik::radiance {

namespace fs = std::filesystem;

std::optional<SceneReader::Frame> SceneReader::frame_of(const Primitive& placed,
                                                        const Frame& frame) {
  const auto own =
      placed.strings.empty() ? std::nullopt : transform_in(std::span(placed.strings).subspan(1));
  if (!own) {
    deviations_.ignored(name_of(placed), "it names no file, or its transform is wrong: left out",
                        placed.place);
    return std::nullopt;
  }
  Frame inner = frame;
  inner.placed = frame.placed * *own;
  return inner;
}

/// An octree may have been made from the text of the same name, which scenes are handed on with.
std::optional<fs::path> SceneReader::compiled_file(const Primitive& primitive, const Frame& frame) {
  const std::string& name = primitive.strings[0];
  const bool is_octree = primitive.type == "instance";
  if (auto path = files_.find(name, frame.folder, primitive.place)) return path;
  const std::string text = fs::path(name).replace_extension(".rad").string();
  if (auto path = is_octree ? files_.find(text, frame.folder, primitive.place) : std::nullopt) {
    deviations_.approximated(
        name_of(primitive),
        fmt::format("there is no '{}': '{}' stands for it", name.substr(0, 100), path->string()),
        primitive.place);
    return path;
  }
  deviations_.missing(name_of(primitive),
                      fmt::format("there is no {} '{}': it is left out",
                                  is_octree ? "octree" : "mesh", name.substr(0, 100)),
                      primitive.place);
  return std::nullopt;
}

void SceneReader::place_octree(const Primitive& instance, const Frame& frame) {
  auto inner = frame_of(instance, frame);
  const auto path = inner ? compiled_file(instance, frame) : std::nullopt;
  if (!path) return;
  const ModifierPointer modifier = modifier_of(instance, frame);
  if (modifier) inner->given = modifier;
  Modifiers& own = own_modifiers_.try_emplace(path->string(), modifiers_).first->second;
  std::swap(modifiers_, own);
  walk_file(*path, *inner, instance.place);
  std::swap(modifiers_, own);
}

const CompiledMesh& SceneReader::mesh_in(const fs::path& path, const Place& place) {
  const auto [entry, is_new] = meshes_.try_emplace(path.string());
  if (is_new) {
    const std::string bytes = files_.text_of(path, place);
    if (!is_compiled(bytes, "Radiance_tmesh"))
      throw Error(ErrorKind::input, fmt::format("'{}' is no compiled mesh", path.string()),
                  "name one that obj2mesh of Radiance has made", place);
    entry->second = read_compiled_mesh(bytes, place_in(path.string()));
  }
  return entry->second;
}

void SceneReader::place_mesh(const std::shared_ptr<const Primitive>& mesh, const Frame& frame) {
  const auto inner = frame_of(*mesh, frame);
  const auto path = inner ? compiled_file(*mesh, frame) : std::nullopt;
  if (!path) return;
  const CompiledMesh& data = mesh_in(*path, mesh->place);
  files_.budget().spend(40 * data.corners.size() + 16 * data.triangles.size(), mesh->place);
  const ModifierPointer modifier = modifier_of(*mesh, frame);
  const auto [entry, is_new] = own_modifiers_.try_emplace(path->string(), modifiers_);
  Modifiers& own = entry->second;
  for (const Statement& statement : data.materials) {
    const auto& primitive = std::get<Primitive>(statement);
    if (!is_new || kind_of(primitive.type) == Kind::surface) continue;
    own.define(std::make_shared<const Primitive>(primitive), inner->placed);
  }
  std::set<int32_t> used;
  for (const auto& triangle : data.triangles) used.insert(triangle.material);
  for (const int32_t material : used) {
    ModifierPointer look = modifier;
    if (!look && material >= 0)
      look = own.find(std::get<Primitive>(data.materials[size_t(material)]).id, mesh->place);
    surfaces_.add_mesh_part({mesh.get(), inner->placed, frame.is_inverted, look.get()}, data,
                            material);
  }
}

void SurfaceMaker::add_mesh_part(const PlacedSurface& surface, const CompiledMesh& data,
                                 int32_t material) {
  std::vector<PatternPoint> points;
  std::vector<uint32_t> faces;
  std::map<uint32_t, uint32_t> known;
  bool is_smooth = true;
  const double side = surface.is_inverted ? -1 : 1;
  const auto corner_of = [&](uint32_t index) {
    const auto [entry, is_new] = known.try_emplace(index, uint32_t(points.size()));
    if (is_new) {
      const CompiledMesh::Corner& corner = data.corners[index];
      PatternPoint point;
      point.position = placed_point(surface.placed, Vec3d(corner.position));
      point.normal = placed_vector(surface.placed, Vec3d(corner.normal)) * side;
      is_smooth = is_smooth && point.normal.length() > 0;
      point.normal = point.normal.normalized();
      point.u = corner.u;
      point.v = corner.v;
      points.push_back(point);
    }
    return entry->second;
  };
  const bool is_turned = is_mirrored(surface.placed) != surface.is_inverted;
  for (const auto& triangle : data.triangles) {
    if (triangle.material != material) continue;
    for (const int i : {0, is_turned ? 2 : 1, is_turned ? 1 : 2})
      faces.push_back(corner_of(triangle.corners[i]));
  }
  if (points.empty()) return;
  std::vector<PatternPoint> samples;
  for (size_t i = 0; i < 8; ++i) samples.push_back(points[i * (points.size() - 1) / 7]);
  const auto appearance = look_at(surface, true, samples);
  if (!appearance) return;
  std::vector<std::pair<double, double>> uvs;
  if (appearance->picture)
    uvs = picture_coordinates(*appearance->picture, points, *surface.primitive, deviations_);
  Mesh own;
  own.appearance = appearance;
  own.place = surface.primitive->place;
  const bool is_lamp = appearance->emitter || appearance->beam;
  Mesh& mesh = is_lamp ? own : mesh_of(surface, appearance, is_smooth, !uvs.empty());
  const auto first = uint32_t(mesh.positions.size() / 3);
  for (size_t i = 0; i < points.size(); ++i) {
    extend(points[i].position, points[i].normal, appearance.get());
    for (int axis = 0; axis < 3; ++axis) {
      mesh.positions.push_back(float(points[i].position[axis]));
      if (is_smooth) mesh.normals.push_back(float(points[i].normal[axis]));
    }
    if (!uvs.empty()) mesh.uvs.insert(mesh.uvs.end(), {float(uvs[i].first), float(uvs[i].second)});
  }
  for (const uint32_t face : faces) mesh.faces.push_back(first + face);
  if (is_lamp) add_mesh(own);
}

}  // namespace kaustik::radiance
