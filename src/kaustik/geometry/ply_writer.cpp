#include "kaustik/geometry/ply_writer.h"

#include <fmt/format.h>

#include <bit>
#include <string>
#include <string_view>
#include <utility>

namespace kaustik {
namespace {

constexpr std::string_view colour_end = "_color";

/// The names of an attribute's properties.
std::vector<std::string> properties_of(const MeshAttribute& attribute) {
  std::string name = attribute.name.substr(attribute.name.find('_') + 1);
  if (attribute.components == 1) return {name + "_x"};
  if (name == "color") return {"r", "g", "b"};
  const bool is_colour = name.ends_with(colour_end);
  if (is_colour) name.resize(name.size() - colour_end.size());
  std::vector<std::string> names;
  for (const char letter : std::string_view(is_colour ? "rgb" : "xyz"))
    names.push_back(fmt::format("{}_{}", name, letter));
  return names;
}

std::vector<const MeshAttribute*> attributes_of(const TriangleMesh& mesh, bool of_faces) {
  std::vector<const MeshAttribute*> some;
  for (const MeshAttribute& attribute : mesh.attributes)
    if (attribute.is_of_faces() == of_faces) some.push_back(&attribute);
  return some;
}

std::string header_of(const TriangleMesh& mesh) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  const auto floats = [&](const auto& names) {
    for (const auto& name : names) text += fmt::format("property float {}\n", name);
  };
  using Names = std::vector<std::string_view>;
  text += fmt::format("element vertex {}\n", mesh.positions.size());
  floats(Names{"x", "y", "z"});
  if (!mesh.normals.empty()) floats(Names{"nx", "ny", "nz"});
  if (!mesh.uvs.empty()) floats(Names{"u", "v"});
  for (const MeshAttribute* attribute : attributes_of(mesh, false))
    floats(properties_of(*attribute));
  text += fmt::format("element face {}\nproperty list uchar uint vertex_indices\n",
                      mesh.triangles.size());
  for (const MeshAttribute* attribute : attributes_of(mesh, true))
    floats(properties_of(*attribute));
  return text + "end_header\n";
}

class Bytes {
 public:
  explicit Bytes(const std::string& text) : bytes_(text.begin(), text.end()) {}

  void reserve(size_t more) { bytes_.reserve(bytes_.size() + more); }
  void add(uint8_t byte) { bytes_.push_back(byte); }
  void add(uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) bytes_.push_back(uint8_t(word >> shift));
  }
  void add(float number) { add(std::bit_cast<uint32_t>(number)); }
  void add(const Vec3f& v) {
    for (const float number : {v.x, v.y, v.z}) add(number);
  }
  /// Those of one vertex or triangle.
  void add(const std::vector<const MeshAttribute*>& attributes, size_t element) {
    for (const MeshAttribute* attribute : attributes)
      for (int i = 0; i < attribute->components; ++i)
        add(attribute->values[element * size_t(attribute->components) + size_t(i)]);
  }
  std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<uint8_t> bytes_;
};

size_t components_of(const std::vector<const MeshAttribute*>& attributes) {
  size_t count = 0;
  for (const MeshAttribute* attribute : attributes) count += size_t(attribute->components);
  return count;
}

}  // namespace

std::vector<uint8_t> ply_file_of(const TriangleMesh& mesh) {
  const auto of_vertices = attributes_of(mesh, false), of_faces = attributes_of(mesh, true);
  Bytes bytes(header_of(mesh));
  bytes.reserve(mesh.positions.size() * 4 * (8 + components_of(of_vertices)) +
                mesh.triangles.size() * (13 + 4 * components_of(of_faces)));
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    bytes.add(mesh.positions[i]);
    if (!mesh.normals.empty()) bytes.add(mesh.normals[i]);
    if (!mesh.uvs.empty()) bytes.add(mesh.uvs[i].x), bytes.add(mesh.uvs[i].y);
    bytes.add(of_vertices, i);
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    bytes.add(uint8_t{3});
    for (const uint32_t corner : mesh.triangles[i]) bytes.add(corner);
    bytes.add(of_faces, i);
  }
  return bytes.take();
}

}  // namespace kaustik
