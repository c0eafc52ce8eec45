#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaustik::gltf {

/// How bytes are packed by EXT_meshopt_compression.
enum class MeshoptMode { attributes, triangles, indices };
/// What becomes of attributes once they are unpacked.
enum class MeshoptFilter { none, octahedral, quaternion, exponential };

struct MeshoptLayout {
  MeshoptMode mode = MeshoptMode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
  size_t count = 0, stride = 0;  ///< elements, and bytes of each

  /// Whether the specification allows it.
  bool is_sound() const;
  /// The least that so many elements can be packed into.
  size_t least_packed_bytes() const;
};

/// The elements, one after the other. Nothing for what is damaged or of another version. As the
/// extension's specification has it, appendices A (bitstream) and B (filters).
std::optional<std::vector<uint8_t>> unpacked_by_meshopt(std::span<const std::byte> packed,
                                                        const MeshoptLayout& layout);

/// Does with unpacked attributes, of so many bytes each, what the filter says.
void apply_meshopt_filter(MeshoptFilter filter, size_t stride, std::vector<uint8_t>& bytes);

}  // namespace kaustik::gltf
