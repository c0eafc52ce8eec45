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
};

/// Fills the values of the attributes, and the faces, of a mesh whose counts and ids are set.
/// False: the data are damaged, have other counts, lack an attribute, or ask for more memory than
/// there is. Faces and vertices take memory in proportion to the counts.
bool unpack_draco(std::span<const std::byte> packed, DracoMesh& mesh);

}  // namespace kaustik::gltf
