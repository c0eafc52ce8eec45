#include "kaustik/loader/nori/meshes.h"

#include "kaustik/base/error.h"
#include "kaustik/loader/nori/lights.h"
#include "kaustik/loader/nori/materials.h"
#include "kaustik/loader/object_maker.h"

namespace kaustik::nori {
namespace {

/// Nori's meshes have the normals of the file, or flat faces. Null: the file is not there.
std::shared_ptr<Object> mesh_of_file(Given& given, const char* type, Reading& reading) {
  const auto name = given.text({"filename"});
  if (!name || name->empty())
    throw Error(ErrorKind::input, "the mesh names no file",
                "write <string name=\"filename\" value=\"mesh.obj\"/>", given.element().place);
  auto shape = make_object("shape", type, given.element().place);
  const Place place = given.place_of({"filename"});
  const auto path = reading.path_of(*name, place, "the mesh is left out");
  if (!path) {
    given.skip({"toworld"});
    return nullptr;
  }
  shape->properties.push_back({"filename", *path, place});
  if (type == std::string_view("obj") && !reading.has_normals(*path))
    give(*shape, "face_normals", true);
  return shape;
}

std::shared_ptr<Object> bare_shape_of(Given& given, Reading& reading) {
  const Object& element = given.element();
  if (element.type == "obj") return mesh_of_file(given, "obj", reading);
  if (element.type == "ply") return mesh_of_file(given, "ply", reading);
  if (element.type == "sphere") {
    auto shape = make_object("shape", "sphere", element.place);
    give(*shape, "center", given.point({"center"}).value_or(Vec3d(0, 0, 0)));
    give(*shape, "radius", given.number({"radius"}).value_or(1));
    return shape;
  }
  reading.ignored(element, "there is no such mesh here");
  return nullptr;
}

/// A child of the mesh, taken or told.
void add_part(Object& shape, const Object& part, Reading& reading, bool& has_bsdf,
              bool& has_medium) {
  if (part.family == "bsdf") {
    if (has_bsdf)
      reading.ignored(part, "the mesh has a bsdf already");
    else
      put(shape, "", bsdf_of(part, reading));
    has_bsdf = true;
  } else if (part.family == "emitter" || part.family == "luminaire") {
    if (auto lamp = area_lamp_of(part, reading)) put(shape, "", std::move(lamp));
  } else if (part.family == "medium" || part.family == "volume") {
    reading.ignored(part, "media of Nori's forks are not rendered");
    has_medium = true;
  } else {
    reading.ignored(part, "there is no such part of a mesh here");
  }
}

}  // namespace

std::shared_ptr<Object> shape_of(const Object& element, Reading& reading) {
  for (const Child& child : element.children)
    if (is_surroundings(*child.object)) {
      reading.approximated(element, "its picture is infinitely far away, without the mesh");
      return lamp_of(*child.object, reading);
    }
  Given given(element, reading.deviations);
  auto shape = bare_shape_of(given, reading);
  if (!shape) return nullptr;
  if (const auto placed = given.transform({"toworld"})) give(*shape, "to_world", *placed);
  bool has_bsdf = false, has_medium = false;
  for (const Child& child : element.children)
    add_part(*shape, *child.object, reading, has_bsdf, has_medium);
  // What only bounds a medium is not seen.
  if (!has_bsdf)
    put(*shape, "",
        has_medium ? make_object("bsdf", "null", element.place) : usual_bsdf(element.place));
  return shape;
}

}  // namespace kaustik::nori
