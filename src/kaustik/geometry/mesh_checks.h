#pragma once
// What readers of meshes check alike, wherever the numbers come from; not for other rooms.

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <string>

#include "kaustik/base/vec.h"

namespace kaustik {

/// What is wrong with a part of a mesh, and what to do.
struct MeshFault {
  std::string message;  ///< "vertex 3 is not finite (…)"
  std::string remedy;
};

/// Nothing where the vertex, its normal or its texture coordinates are finite.
std::optional<MeshFault> fault_of_position(uint64_t vertex, const Vec3f& position);
std::optional<MeshFault> fault_of_normal(uint64_t vertex, const Vec3f& normal);
std::optional<MeshFault> fault_of_uv(uint64_t vertex, const Vec2f& uv);
/// Whether all numbers of vectors of floats are finite; which one is not, the above tell.
template <typename Vector>
bool are_finite(std::span<const Vector> vectors) {
  const auto* numbers = reinterpret_cast<const float*>(vectors.data());
  uint32_t largest = 0;
  for (size_t i = 0; i < vectors.size_bytes() / sizeof(float); ++i)
    largest = std::max(largest, std::bit_cast<uint32_t>(numbers[i]) & 0x7fffffffu);
  return largest < std::bit_cast<uint32_t>(infinity);
}
/// Nothing where the index is that of one of the vertices; the remedy is the reader's.
std::optional<MeshFault> fault_of_index(uint64_t face, double index, uint64_t vertices,
                                        const char* remedy);
/// Nothing where 32 bits can count so many elements that are called `name`.
std::optional<MeshFault> fault_of_count(uint64_t count, const std::string& name);
/// The fault of a mesh without faces.
MeshFault fault_of_no_faces();

}  // namespace kaustik
