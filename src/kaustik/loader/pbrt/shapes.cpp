#include "kaustik/loader/pbrt/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kaustik/base/file.h"
#include "kaustik/base/gzip.h"
#include "kaustik/loader/near_names.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::pbrt {
namespace {

template <typename T>
std::shared_ptr<const Array> array_of(std::shared_ptr<std::vector<T>> values, size_t columns) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(std::as_const(*values)));
  const size_t rows = values->size() / columns;
  return Array::borrow(element_type_of<T>(), {rows, columns}, bytes, std::move(values));
}

template <typename T>
Value shared_array(std::vector<T> values, size_t columns) {
  return array_of(std::make_shared<std::vector<T>>(std::move(values)), columns);
}

/// Tuples for each vertex under one of two names; null: there are none, or not as many as vertices,
/// which is told.
std::shared_ptr<std::vector<float>> per_vertex(const ShapeTools& tools, const char* name,
                                               size_t columns, size_t vertices) {
  const Parameter* parameter = tools.list.find(name);
  if (!parameter) return nullptr;
  auto values = parameter->floats;
  if (!values) {
    values = std::make_shared<std::vector<float>>();
    for (const double number : parameter->numbers) values->push_back(float(number));
  }
  if (values->size() == columns * vertices) return values;
  tools.deviations.ignored(tools.object,
                           fmt::format("{} has {} numbers, and its {} vertices need {} each",
                                       shown(name), values->size(), vertices, columns),
                           parameter->place);
  return nullptr;
}

Vec3d vertex(const std::vector<float>& positions, size_t index) {
  return {double(positions[3 * index]), double(positions[3 * index + 1]),
          double(positions[3 * index + 2])};
}

/// Whether the PLY file gives normals: without them its faces are flat.
bool ply_has_normals(const std::filesystem::path& path) {
  constexpr size_t longest_header = 64 << 10;
  const std::vector<uint8_t> start =
      unpacked_start(read_file_start(path.string(), longest_header), longest_header);
  std::string_view header(reinterpret_cast<const char*>(start.data()), start.size());
  header = header.substr(0, header.find("end_header"));
  for (const std::string_view name : {" nx\n", " nx\r", " nx "})
    if (header.find(name) != std::string_view::npos) return true;
  return false;
}

}  // namespace

std::shared_ptr<Object> placed(std::shared_ptr<Object> shape, const ShapeTools& tools) {
  const Property* own = find_property(*shape, "to_world");
  Transform to_world = tools.to_world;
  if (own) to_world = to_world * std::get<Transform>(own->value);
  remove_property(*shape, "to_world");
  if (!(to_world == Transform())) set(*shape, "to_world", to_world);
  if (tools.is_flipped) set(*shape, "flip_normals", true);
  return shape;
}

std::shared_ptr<Object> shape_of(MeshParts mesh, const Place& place) {
  auto shape = described("shape", "mesh", place);
  set(*shape, "positions", shared_array(std::move(mesh.positions), 3));
  set(*shape, "faces", shared_array(std::move(mesh.faces), 3));
  if (mesh.normals.empty()) {
    set(*shape, "face_normals", true);
  } else {
    set(*shape, "normals", shared_array(std::move(mesh.normals), 3));
    set(*shape, "front_by_normals", true);
  }
  if (!mesh.uv.empty()) set(*shape, "uv", shared_array(std::move(mesh.uv), 2));
  return shape;
}

std::shared_ptr<std::vector<float>> vertices_of(const ParameterList& list) {
  const Parameter* points = list.find("P", {"point3"});
  if (points && !points->floats->empty() && points->floats->size() % 3 == 0) return points->floats;
  throw Error(ErrorKind::input,
              points ? "'P' does not hold three numbers for each vertex" : "the shape has no 'P'",
              "give its vertices, \"point3 P\" [ x y z … ]", list.place_of("P"));
}

std::shared_ptr<std::vector<int32_t>> indices_of(const ParameterList& list, size_t tuple,
                                                 size_t vertices) {
  const Parameter* given = list.find("indices", {"integer"});
  auto indices = given ? given->integers : nullptr;
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::input, message,
                fmt::format("give {} for each face, counted from 0", tuple),
                list.place_of("indices"));
  };
  if (!indices || indices->empty()) {
    if (vertices != tuple) refuse("the shape has no 'indices'");
    indices = std::make_shared<std::vector<int32_t>>();
    for (size_t i = 0; i < tuple; ++i) indices->push_back(int32_t(i));
  }
  if (indices->size() % tuple != 0)
    refuse(fmt::format("'indices' has {} numbers", indices->size()));
  for (const int32_t index : *indices)
    if (index < 0 || size_t(index) >= vertices)
      refuse(fmt::format("index {} names none of the {} vertices", index, vertices));
  return indices;
}

std::shared_ptr<Object> make_triangles(const ShapeTools& tools) {
  const auto positions = vertices_of(tools.list);
  const size_t vertices = positions->size() / 3;
  const auto faces = indices_of(tools.list, 3, vertices);
  const auto normals = per_vertex(tools, "N", 3, vertices);
  const char* const uv_name = tools.list.has("st") ? "st" : "uv";
  const auto uv = per_vertex(tools, uv_name, 2, vertices);
  if (tools.list.has("S"))
    tools.deviations.ignored(tools.object, "tangents have no effect: those of uv count",
                             tools.list.place_of("S"));
  tools.list.accept({"faceIndices", "discarddegenerateUVs"});
  tools.lamps = faces->size() / 3;
  auto shape = described("shape", "mesh", tools.place());
  set(*shape, "positions", array_of(positions, 3));
  set(*shape, "faces", array_of(faces, 3));
  if (normals) {
    set(*shape, "normals", array_of(normals, 3));
    set(*shape, "front_by_normals", true);
  } else {
    set(*shape, "face_normals", true);
  }
  if (uv) set(*shape, "uv", array_of(uv, 2));
  return placed(shape, tools);
}

std::shared_ptr<Object> make_bilinear_patches(const ShapeTools& tools) {
  const auto positions = vertices_of(tools.list);
  const size_t vertices = positions->size() / 3;
  const auto indices = indices_of(tools.list, 4, vertices);
  const auto normals = per_vertex(tools, "N", 3, vertices);
  const auto uv = per_vertex(tools, "uv", 2, vertices);
  tools.list.accept({"faceIndices"});
  if (tools.list.has("emissionfilename"))
    tools.deviations.ignored(tools.object, "'emissionfilename' has no effect",
                             tools.list.place_of("emissionfilename"));
  tools.lamps = indices->size() / 4;
  constexpr int cells = 8;  // along the sides of a patch that is curved
  MeshParts mesh;
  for (size_t patch = 0; patch + 3 < indices->size(); patch += 4) {
    size_t corner[4];
    for (size_t i = 0; i < 4; ++i) corner[i] = size_t((*indices)[patch + i]);
    const Vec3d p00 = vertex(*positions, corner[0]), p10 = vertex(*positions, corner[1]),
                p01 = vertex(*positions, corner[2]), p11 = vertex(*positions, corner[3]);
    const Vec3d across = (p10 - p00).cross(p01 - p00);
    const double size = std::max((p11 - p00).length(), (p10 - p01).length());
    const bool is_flat = std::fabs((p11 - p00).dot(across)) <= 1e-5 * across.length() * size;
    const int n = is_flat ? 1 : cells;
    const auto first = int32_t(mesh.positions.size() / 3);
    const auto blend = [&](auto of, double u, double v) {
      return of(0) * ((1 - u) * (1 - v)) + of(1) * (u * (1 - v)) + of(2) * ((1 - u) * v) +
             of(3) * (u * v);
    };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double u = double(i) / n, v = double(j) / n;
        append(mesh.positions, blend([&](int k) { return vertex(*positions, corner[k]); }, u, v));
        if (normals)
          append(mesh.normals, blend([&](int k) { return vertex(*normals, corner[k]); }, u, v));
        for (size_t axis = 0; axis < 2; ++axis)
          mesh.uv.push_back(
              uv ? float(blend([&](int k) { return double((*uv)[2 * corner[k] + axis]); }, u, v))
                 : float(axis == 0 ? u : v));
      }
    append_cells(mesh.faces, first, n, n);
  }
  // A lone rectangle runs round its rim, as the renderer expects of lamps that it samples best.
  if (mesh.positions.size() == 12 && mesh.faces.size() == 6) {
    for (size_t axis = 0; axis < 3; ++axis) {
      std::swap(mesh.positions[6 + axis], mesh.positions[9 + axis]);
      if (!mesh.normals.empty()) std::swap(mesh.normals[6 + axis], mesh.normals[9 + axis]);
    }
    for (size_t axis = 0; axis < 2; ++axis) std::swap(mesh.uv[4 + axis], mesh.uv[6 + axis]);
    mesh.faces = {0, 1, 2, 0, 2, 3};
  }
  tools.files.spend(mesh.bytes(), tools.place());
  return placed(shape_of(std::move(mesh), tools.place()), tools);
}

std::shared_ptr<Object> make_ply(const ShapeTools& tools) {
  const std::string name = tools.list.text("filename");
  tools.list.accept({"edgelength"});
  const auto path = tools.files.find(name, tools.place());
  if (!path) {
    tools.deviations.missing(tools.object,
                             fmt::format("mesh {} is not there: it is left out", shown(name)),
                             tools.list.place_of("filename"), where_files_lie);
    return nullptr;
  }
  if (tools.list.has("displacement"))
    tools.deviations.ignored(tools.object, "its displacement is left out: it has its own faces",
                             tools.list.place_of("displacement"));
  auto shape = described("shape", "ply", tools.place());
  set(*shape, "filename", path->string());
  set(*shape, ply_has_normals(*path) ? "front_by_normals" : "face_normals", true);
  return placed(shape, tools);
}

std::shared_ptr<Object> make_subdivided(const ShapeTools& tools) {
  const auto positions = vertices_of(tools.list);
  const auto faces = indices_of(tools.list, 3, positions->size() / 3);
  int levels = std::clamp(tools.list.integer("levels", tools.list.integer("nlevels", 3)), 0, 12);
  tools.list.accept({"scheme"});
  // Each level has four times the faces: a few levels are usual, more stay in bounds.
  constexpr size_t most_faces = size_t{1} << 16;
  constexpr int usual_levels = 4;
  const int wanted = levels;
  while (levels > usual_levels && (faces->size() / 3) << (2 * levels) > most_faces) --levels;
  if (levels < wanted)
    tools.approximated(fmt::format("it is divided {} times, not {}", levels, wanted));
  tools.files.spend((faces->size() << (2 * levels)) * 3 * sizeof(float), tools.place());
  tools.lamps = (faces->size() / 3) << (2 * levels);
  return placed(shape_of(subdivided(*positions, *faces, levels), tools.place()), tools);
}

std::optional<MeshBuffers> buffers_of(const Object& shape) {
  const auto floats = [&](const char* name) {
    const auto* array = value_in<std::shared_ptr<const Array>>(shape, name);
    return array ? std::span(reinterpret_cast<const float*>((*array)->bytes().data()),
                             (*array)->count())
                 : std::span<const float>();
  };
  const auto* faces = value_in<std::shared_ptr<const Array>>(shape, "faces");
  if (shape.type != "mesh" || !faces) return std::nullopt;
  return MeshBuffers{
      floats("positions"),
      floats("normals"),
      floats("uv"),
      {reinterpret_cast<const int32_t*>((*faces)->bytes().data()), (*faces)->count()}};
}

namespace {

using ShapeMaker = std::shared_ptr<Object> (*)(const ShapeTools&);

const std::map<std::string_view, ShapeMaker>& shape_makers() {
  static const std::map<std::string_view, ShapeMaker> rows = {
      {"bilinearmesh", make_bilinear_patches},
      {"cone", make_cone},
      {"cylinder", make_cylinder},
      {"disk", make_disk},
      {"heightfield", make_heightfield},
      {"hyperboloid", make_hyperboloid},
      {"loopsubdiv", make_subdivided},
      {"paraboloid", make_paraboloid},
      {"plymesh", make_ply},
      {"sphere", make_sphere},
      {"trianglemesh", make_triangles},
  };
  return rows;
}

}  // namespace

std::shared_ptr<Object> make_shape(const ShapeTools& tools, const std::string& type) {
  const auto maker = shape_makers().find(type);
  if (maker != shape_makers().end()) return maker->second(tools);
  for (const Parameter& parameter : tools.list.all()) parameter.is_used = true;
  std::vector<std::string> known = names_in(shape_makers());
  known.emplace_back("curve");
  tools.deviations.missing(tools.object,
                           fmt::format("there is no shape {}: it is left out", shown(type)),
                           tools.place(), did_you_mean(type, known));
  return nullptr;
}

}  // namespace kaustik::pbrt
