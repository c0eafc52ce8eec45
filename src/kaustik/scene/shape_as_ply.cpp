#include "kaustik/scene/shape_as_ply.h"

#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/ply_writer.h"
#include "kaustik/scene/arguments_alone.h"
#include "kaustik/scene/scene.h"

namespace kaustik {
namespace {

ShapeAsPly file_as_ply(const Object& shape) {
  const MeshFile mesh = unplaced_mesh(arguments_alone(shape));
  return {ply_file_of(mesh.mesh), mesh.has_face_normals};
}

/// Its heights may be those of a texture, which only a scene knows: it is built of the field alone,
/// flat and where it lies in its own space.
ShapeAsPly field_as_ply(const Object& shape) {
  const auto field = std::make_shared<Object>(shape);
  std::erase_if(field->children,
                [](const Child& child) { return child.object->family != "texture"; });
  std::erase_if(field->properties, [](const Property& property) {
    return property.name == "to_world" || property.name == "flip_normals" ||
           property.name == "shading_normals";
  });
  field->properties.push_back({"shading_normals", false, shape.place});
  Description alone;
  alone.scene = std::make_shared<Object>(Object{"scene", "", "", {}, {{"", field}}, shape.place});
  const std::shared_ptr<const Scene> scene = build_scene(alone);
  return {ply_file_of(*scene->tracer().shape(0).mesh())};
}

}  // namespace

ShapeAsPly shape_as_ply(const Object& shape) {
  return shape.type == "heightfield" ? field_as_ply(shape) : file_as_ply(shape);
}

}  // namespace kaustik
