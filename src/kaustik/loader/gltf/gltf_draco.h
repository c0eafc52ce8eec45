#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaustik::gltf {

/// A mesh that KHR_draco_mesh_compression has packed.
struct DracoMesh {
  /// Of an attribute that the extension names.
  struct Attribute {
    uint32_t id = 0;        ///< its unique id in the packed data
    size_t components = 0;  ///< numbers of each vertex
    float scale = 1;        ///< that its numbers are multiplied by
    std::vector<float> values;
  };
  size_t vertices = 0, corners = 0;  ///< as the file's accessors have them
  std::vector<Attribute> attributes;
  std::vector<uint32_t> faces;  ///< three corners for each triangle

  /// What the packed attributes may take of each vertex: numbers of 64 bits for all that are asked
  /// for, and some for those that nobody asks for.
  size_t most_vertex_bytes() const {
    size_t components = 8;
    for (const Attribute& attribute : attributes) components += attribute.components;
    return 8 * components;
  }
};

/// Fills the values of the attributes, and the faces, of a mesh whose counts and ids are set.
/// False: the data are damaged, have other counts, lack an attribute, or ask for more memory than
/// there is. Faces take memory in proportion to their count, vertices `most_vertex_bytes()` each,
/// and about the same again while they are decoded.
bool unpack_draco(std::span<const std::byte> packed, DracoMesh& mesh);

}  // namespace kaustik::gltf
