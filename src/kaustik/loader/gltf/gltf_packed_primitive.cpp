#include "kaustik/loader/gltf/gltf_packed_primitive.h"

#include <limits>
#include <utility>

#include "kaustik/loader/gltf/gltf_draco.h"

namespace kaustik::gltf {
namespace {

constexpr const char* extension_name = "KHR_draco_mesh_compression";

/// An attribute, and the accessor that it is for.
struct Target {
  size_t accessor = 0;
  DracoMesh::Attribute attribute;
};

[[noreturn]] void give_up(const std::string& why) {
  throw MissingData{std::string("its data, packed by ") + extension_name + ", " + why +
                    ": export it again"};
}

/// Those attributes of the primitive that are packed.
std::vector<Target> targets_of(const File& file, const Accessors& accessors,
                               const JsonValue& primitive, const JsonValue& packed,
                               size_t vertices) {
  const JsonValue* attributes = primitive.find("attributes");
  const JsonValue* ids = packed.find("attributes");
  std::vector<Target> targets;
  for (const auto& [name, value] : attributes->members()) {
    const auto accessor = file.count(*attributes, name);
    const bool has_numbers =
        !accessor || file.item("accessors", *accessor, *attributes).find("bufferView");
    if (!has_numbers && !(ids && ids->find(name))) give_up("lack " + name);
  }
  if (!ids) return targets;
  for (const auto& [name, value] : ids->members()) {
    const auto id = file.count(*ids, name);
    const auto accessor = file.count(*attributes, name);
    if (!id || !accessor || *id > std::numeric_limits<uint32_t>::max()) continue;
    const AccessorShape shape = accessors.shape(*accessor, *attributes);
    if (shape.count != vertices) give_up("have attributes of different lengths");
    targets.push_back({*accessor, {uint32_t(*id), shape.components, shape.scale, {}}});
  }
  return targets;
}

}  // namespace

void supply_unpacked(File& file, Accessors& accessors, const JsonValue& primitive) {
  const JsonValue* packed = file.extension(primitive, extension_name);
  const JsonValue* attributes = primitive.find("attributes");
  if (!packed || !attributes) return;
  const auto position = file.count(*attributes, "POSITION");
  if (!position || accessors.knows_floats(*position) ||
      file.item("accessors", *position, *attributes).find("bufferView"))
    return;
  const auto indices = file.count(primitive, "indices"), view = file.count(*packed, "bufferView");
  constexpr size_t triangles = 4;
  if (!indices || !view || file.count(primitive, "mode").value_or(triangles) != triangles)
    give_up("are no triangles");
  DracoMesh mesh;
  mesh.vertices = accessors.shape(*position, *attributes).count;
  mesh.corners = accessors.shape(*indices, primitive).count;
  std::vector<Target> targets = targets_of(file, accessors, primitive, *packed, mesh.vertices);
  for (const Target& target : targets) mesh.attributes.push_back(target.attribute);
  // The decoder has all of it, too.
  file.spend(2 * sizeof(float) * mesh.corners, primitive);
  file.spend(2 * mesh.most_vertex_bytes() * mesh.vertices, primitive);
  if (!unpack_draco(file.view(*view, *packed).bytes, mesh)) give_up("are damaged");
  for (size_t i = 0; i < targets.size(); ++i) {
    DracoMesh::Attribute& attribute = mesh.attributes[i];
    accessors.supply_floats(
        targets[i].accessor,
        Array::of<float>({mesh.vertices, attribute.components}, std::move(attribute.values)));
  }
  accessors.supply_indices(*indices, Array::of<uint32_t>({mesh.corners}, std::move(mesh.faces)));
}

}  // namespace kaustik::gltf
