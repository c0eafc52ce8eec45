// The shapes that are meshes: `obj` and `ply` files, `mesh` buffers, `rectangle` and `cube`.

#include <algorithm>

#include "kaustik/geometry/mesh_buffers.h"
#include "kaustik/geometry/mesh_reader.h"
#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"

namespace kaustik {
namespace {

/// The rows that say what becomes of a mesh, wherever it comes from.
std::vector<Parameter> mesh_option_parameters(bool flip_tex_coords) {
  return {
      to_world_parameter("Places the mesh in the world.").leaving(2),
      boolean_parameter("face_normals", false,
                        "Flat faces, without the normals of the file. If false, a mesh without "
                        "normals gets smooth ones."),
      optional(number_parameter("max_smooth_angle", 0,
                                "Computes new normals: smooth, except at edges whose faces differ "
                                "in direction by more than this angle.")
                   .range(0, 180)
                   .in("degrees")),
      boolean_parameter("flip_normals", false, "Turns the surface inside out."),
      boolean_parameter("flip_tex_coords", flip_tex_coords,
                        "Turns texture coordinates upside down (v becomes 1 - v)."),
      boolean_parameter("front_by_normals", false,
                        "Turns each triangle to the side of its vertex normals, as pbrt does."),
  };
}

std::vector<Parameter> with_options(std::vector<Parameter> rows, bool flip_tex_coords) {
  for (Parameter& row : mesh_option_parameters(flip_tex_coords)) rows.push_back(std::move(row));
  return rows;
}

MeshOptions mesh_options(const Arguments& arguments) {
  MeshOptions options{.to_world = affine_to_world(arguments),
                      .face_normals = arguments.boolean("face_normals"),
                      .flip_normals = arguments.boolean("flip_normals"),
                      .flip_tex_coords = arguments.boolean("flip_tex_coords")};
  if (arguments.given("max_smooth_angle"))
    options.max_smooth_angle = arguments.number("max_smooth_angle");
  return options;
}

std::vector<Parameter> file_mesh_parameters(bool flip_tex_coords) {
  return with_options({file_parameter("filename", "Mesh file.")}, flip_tex_coords);
}

/// With each triangle turned to the side of its vertex normals where that is wanted.
MeshFile turned_as_wanted(MeshFile file, const Arguments& arguments) {
  TriangleMesh& mesh = file.mesh;
  if (!arguments.boolean("front_by_normals") || mesh.normals.empty()) return file;
  for (std::array<uint32_t, 3>& corner : mesh.triangles) {
    const Vec3d a(mesh.positions[corner[0]]);
    const Vec3d front =
        (Vec3d(mesh.positions[corner[1]]) - a).cross(Vec3d(mesh.positions[corner[2]]) - a);
    Vec3d normals(0, 0, 0);
    for (const uint32_t vertex : corner) normals += Vec3d(mesh.normals[vertex]);
    if (front.dot(normals) < 0) std::swap(corner[1], corner[2]);
  }
  return file;
}

MeshFile read_selected_obj(const Arguments& arguments) {
  ObjSelection selection;
  if (const int64_t index = arguments.integer("shape_index"); index >= 0)
    selection.shape_index = uint64_t(index);
  if (arguments.given("material")) selection.material = arguments.text("material");
  return read_obj(arguments.text("filename"), selection);
}

std::unique_ptr<Shape> create_from_file(const Arguments& arguments) {
  MeshOptions options = mesh_options(arguments);
  MeshFile file = *read_mesh_file(arguments);
  options.face_normals = options.face_normals || file.has_face_normals;
  return std::make_unique<MeshShape>(
      prepare_mesh(std::move(file.mesh), options, place_in(arguments.text("filename"))),
      std::move(file.remarks));
}

std::unique_ptr<Shape> create_built_in(const Arguments& arguments, TriangleMesh mesh) {
  MeshOptions options;
  options.to_world = affine_to_world(arguments);
  options.face_normals = true;
  options.flip_normals = arguments.boolean("flip_normals");
  return std::make_unique<MeshShape>(
      prepare_mesh(std::move(mesh), options, arguments.place_of("to_world")));
}

std::vector<Parameter> built_in_parameters() {
  return {to_world_parameter("Places the shape in the world.").leaving(2),
          boolean_parameter("flip_normals", false, "Turns the surface inside out.")};
}

/// Two triangles over the square center ± u ± v, seen from u × v.
void add_square(TriangleMesh& mesh, const Vec3f& middle, const Vec3f& u, const Vec3f& v) {
  const auto first = uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(),
                        {middle - u - v, middle + u - v, middle + u + v, middle - u + v});
  mesh.uvs.insert(mesh.uvs.end(), {Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1)});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

}  // namespace

const TypeInfo& obj_info() {
  static const TypeInfo info = [] {
    TypeInfo made{"shape", "obj", "Triangle mesh from a Wavefront OBJ file.",
                  file_mesh_parameters(true)};
    made.parameters.insert(
        made.parameters.begin() + 1,
        {integer_parameter("shape_index", -1,
                           "Number of one part to load, from 0; lines 'g' and 'usemtl' divide the "
                           "file into parts. -1: all parts.")
             .range(-1, 0x7fffffff),
         optional(
             text_parameter("material", "", "Loads only the faces of this material ('usemtl').")),
         ignored_parameter("collapse", ParameterKind::boolean)});
    return made;
  }();
  return info;
}
std::unique_ptr<Shape> create_obj(const Arguments& arguments) {
  return create_from_file(arguments);
}

const TypeInfo& ply_info() {
  static const TypeInfo info = [] {
    TypeInfo made{"shape", "ply",
                  "Triangle mesh from a PLY file (text, or binary of either byte order).",
                  file_mesh_parameters(false)};
    made.parameters.push_back(ignored_parameter("srgb", ParameterKind::boolean));
    return made;
  }();
  return info;
}
std::unique_ptr<Shape> create_ply(const Arguments& arguments) {
  return create_from_file(arguments);
}

const TypeInfo& serialized_info() {
  static const TypeInfo info = [] {
    TypeInfo made{"shape", "serialized", "Triangle mesh from one of Mitsuba's packed files.",
                  file_mesh_parameters(false)};
    made.parameters.insert(
        made.parameters.begin() + 1,
        integer_parameter("shape_index", 0, "Number of the mesh in the file, from 0.")
            .range(0, 0x7fffffff));
    return made;
  }();
  return info;
}
std::unique_ptr<Shape> create_serialized(const Arguments& arguments) {
  return create_from_file(arguments);
}

std::optional<MeshFile> read_mesh_file(const Arguments& arguments) {
  const std::string& type = arguments.info().name;
  const auto turned = [&](MeshFile file) { return turned_as_wanted(std::move(file), arguments); };
  if (type == "obj") return turned(read_selected_obj(arguments));
  if (type == "ply") return turned(read_ply(arguments.text("filename")));
  if (type == "serialized")
    return turned(
        read_serialized(arguments.text("filename"), uint64_t(arguments.integer("shape_index"))));
  if (type == "mesh") return turned({mesh_of_buffers(arguments), {}});
  return std::nullopt;
}

MeshFile unplaced_mesh(const Arguments& arguments) {
  MeshFile file = *read_mesh_file(arguments);
  TriangleMesh& mesh = file.mesh;
  const auto is_missing = [](const Vec3f& n) { return n == Vec3f(0, 0, 0); };
  const auto missing = std::count_if(mesh.normals.begin(), mesh.normals.end(), is_missing);
  if (size_t(missing) == mesh.normals.size()) mesh.normals.clear();
  // Zero is no direction to other programs.
  if (!mesh.normals.empty() && missing > 0) {
    const std::vector<Vec3f> smooth = smooth_normals(mesh);
    for (size_t i = 0; i < smooth.size(); ++i)
      if (is_missing(mesh.normals[i])) mesh.normals[i] = smooth[i];
  }
  MeshOptions options = mesh_options(arguments);
  if (options.face_normals || file.has_face_normals) {
    mesh.normals.clear();
    options.max_smooth_angle.reset();
  }
  if (options.flip_tex_coords)
    for (Vec2f& uv : mesh.uvs) uv.y = 1.0f - uv.y;
  options.flip_normals = options.flip_tex_coords = false;
  if (options.max_smooth_angle) mesh = prepare_mesh(std::move(mesh), options, arguments.place());
  return file;
}

const TypeInfo& mesh_info() {
  static const TypeInfo info{"shape", "mesh",
                             "Triangle mesh from a program's buffers. Scene files cannot have it.",
                             with_options(mesh_buffer_parameters(), false)};
  return info;
}
std::unique_ptr<Shape> create_mesh(const Arguments& arguments) {
  const MeshOptions options = mesh_options(arguments);
  return std::make_unique<MeshShape>(
      prepare_mesh(read_mesh_file(arguments)->mesh, options, arguments.place_of("positions")));
}

const TypeInfo& rectangle_info() {
  static const TypeInfo info{"shape", "rectangle",
                             "The square [-1, 1] x [-1, 1] in the xy plane, facing +z.",
                             built_in_parameters()};
  return info;
}
std::unique_ptr<Shape> create_rectangle(const Arguments& arguments) {
  TriangleMesh mesh;
  add_square(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  return create_built_in(arguments, std::move(mesh));
}

const TypeInfo& cube_info() {
  static const TypeInfo info{"shape", "cube", "The cube from (-1, -1, -1) to (1, 1, 1).",
                             built_in_parameters()};
  return info;
}
std::unique_ptr<Shape> create_cube(const Arguments& arguments) {
  TriangleMesh mesh;
  const Vec3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  add_square(mesh, x, y, z);
  add_square(mesh, -x, z, y);
  add_square(mesh, y, z, x);
  add_square(mesh, -y, x, z);
  add_square(mesh, z, x, y);
  add_square(mesh, -z, y, x);
  return create_built_in(arguments, std::move(mesh));
}

}  // namespace kaustik
