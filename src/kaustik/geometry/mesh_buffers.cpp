#include "kaustik/geometry/mesh_buffers.h"
#include "kaustik/base/memory.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <span>
#include <type_traits>

#include "kaustik/geometry/mesh_attribute.h"
#include "kaustik/geometry/mesh_checks.h"

namespace kaustik {
namespace {

/// Makes what a mesh consists of, one buffer at a time.
class BufferReader {
 public:
  explicit BufferReader(const Arguments& arguments) : arguments_(arguments) {}

  std::vector<Vec3f> positions() {
    start("positions");
    return tuples<Vec3f>(fault_of_position);
  }
  std::vector<Vec3f> normals(size_t vertices) {
    if (!start("normals")) return {};
    expect_one_per_vertex(vertices);
    return tuples<Vec3f>(fault_of_normal);
  }
  std::vector<Vec2f> uvs(size_t vertices) {
    if (!start("uv")) return {};
    expect_one_per_vertex(vertices);
    return tuples<Vec2f>(fault_of_uv);
  }
  TriangleList faces(size_t vertices) {
    start("faces");
    if (rows() == 0) fail(fault_of_no_faces());
    TriangleList faces(rows());
    array_->visit([&](auto values) {
      for (size_t i = 0; i < values.size(); ++i) {
        check(fault_of_index(i / 3, double(values[i]), vertices,
                             "indices count the rows of 'positions' from 0"));
        faces[i / 3][i % 3] = uint32_t(values[i]);
      }
    });
    return faces;
  }

  /// None: it was not given.
  std::optional<MeshAttribute> attribute(const MeshAttribute& row, size_t wanted) {
    if (!start(row.name.c_str())) return std::nullopt;
    if (row.is_of_faces())
      expect_rows(wanted, "faces", "give one row for each triangle");
    else
      expect_one_per_vertex(wanted);
    MeshAttribute made = row;
    reserve_large(made.values, array_->count());
    array_->visit([&]<typename T>(std::span<const T> values) {
      const double largest = std::is_integral_v<T> ? double(std::numeric_limits<T>::max()) : 0.0;
      for (const T value : values) made.values.push_back(attribute_value(double(value), largest));
    });
    for (size_t i = 0; i < made.values.size(); ++i)
      if (!std::isfinite(made.values[i]))
        fail({fmt::format("row {} is not finite", i / size_t(row.components)),
              "give numbers alone"});
    return made;
  }

 private:
  /// False: it was not given.
  bool start(const char* name) {
    name_ = name;
    array_ = arguments_.array(name).get();
    if (!array_) return false;
    check(fault_of_count(rows(), name));
    return true;
  }
  size_t rows() const { return array_->extents()[0]; }

  [[noreturn]] void fail(const MeshFault& fault) const {
    throw Error(ErrorKind::input, fmt::format("'{}': {}", name_, fault.message), fault.remedy,
                arguments_.place_of(name_));
  }
  void check(const std::optional<MeshFault>& fault) const {
    if (fault) fail(*fault);
  }
  void expect_one_per_vertex(size_t vertices) const {
    expect_rows(vertices, "positions", "give one row for each vertex");
  }
  void expect_rows(size_t wanted, const char* of, const char* remedy) const {
    if (rows() != wanted)
      fail({fmt::format("it has {} rows, and '{}' has {}", rows(), of, wanted), remedy});
  }

  template <typename Tuple>
  std::vector<Tuple> tuples(std::optional<MeshFault> (*fault_of)(uint64_t, const Tuple&)) const {
    constexpr size_t size = sizeof(Tuple) / sizeof(float);
    std::vector<Tuple> result;
    reserve_large(result, rows() + 1);  // see MeshShape
    array_->visit([&](auto values) {
      for (size_t row = 0; row < rows(); ++row) {
        Tuple tuple;
        for (size_t i = 0; i < size; ++i) tuple[int(i)] = float(values[row * size + i]);
        check(fault_of(row, tuple));
        result.push_back(tuple);
      }
    });
    return result;
  }

  const Arguments& arguments_;
  const char* name_ = "";
  const Array* array_ = nullptr;
};

/// Those that buffers may have, without values.
const std::vector<MeshAttribute>& attribute_rows() {
  static const std::vector<MeshAttribute> rows = {
      {"vertex_color", 3}, {"face_color", 3}, {"vertex_value", 1}, {"face_value", 1}};
  return rows;
}

}  // namespace

TriangleMesh mesh_of_buffers(const Arguments& arguments) {
  BufferReader reader(arguments);
  TriangleMesh mesh;
  mesh.positions = reader.positions();
  mesh.triangles = reader.faces(mesh.positions.size());
  mesh.normals = reader.normals(mesh.positions.size());
  mesh.uvs = reader.uvs(mesh.positions.size());
  for (const MeshAttribute& row : attribute_rows()) {
    const size_t wanted = row.is_of_faces() ? mesh.triangles.size() : mesh.positions.size();
    if (auto attribute = reader.attribute(row, wanted))
      mesh.attributes.push_back(std::move(*attribute));
  }
  return mesh;
}

std::vector<Parameter> mesh_buffer_parameters() {
  return {required(array_parameter("positions", {0, 3}, "Vertices, in the mesh's own space.")),
          required(array_parameter("faces", {0, 3},
                                   "The three vertices of each triangle, counted from 0.")
                       .integers()),
          array_parameter("normals", {0, 3}, "Normal of each vertex, of any length."),
          array_parameter("uv", {0, 2}, "Texture coordinates of each vertex."),
          array_parameter("vertex_color", {0, 3},
                          "Colour of each vertex, for textures of type mesh_attribute: linear "
                          "floats, or sRGB integers as in 8-bit pictures."),
          array_parameter("face_color", {0, 3}, "Colour of each triangle, likewise."),
          array_parameter("vertex_value", {0},
                          "Number at each vertex, for textures of type mesh_attribute."),
          array_parameter("face_value", {0}, "Number at each triangle, likewise.")};
}

}  // namespace kaustik
