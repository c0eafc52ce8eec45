#pragma once
#include <cstddef>
#include <cstdint>

#include "kaustik/scene.h"

namespace kaustik::v0 {

/// Where rows of numbers lie: so many, from one to the next `stride_bytes` (0: packed).
template <typename T>
struct Rows {
  const T* data = nullptr;
  size_t count = 0;
  ptrdiff_t stride_bytes = 0;
};

/// What a mesh is made of; what has no rows is absent.
struct MeshBuffers {
  Rows<float> positions;  ///< x, y, z of each vertex, m, in the mesh's own space
  Rows<uint32_t> faces;   ///< the three vertices of each triangle, counted from 0
  Rows<float> normals;    ///< x, y, z of each vertex, of any length
  Rows<float> uv;         ///< texture coordinates of each vertex
};

/// A mesh of triangles in memory. Immutable; copies share the numbers, and so do all scenes that it
/// is in.
class KAUSTIK_EXPORT Mesh {
 public:
  /// Copies the buffers. Throws Error if positions or faces are absent. What else is wrong with
  /// them is told where a scene is built.
  explicit Mesh(const MeshBuffers& buffers);

  size_t vertex_count() const noexcept { return vertex_count_; }
  size_t face_count() const noexcept { return face_count_; }
  /// A shape of type mesh, for a scene: give it a bsdf, and what else docs/reference lists.
  Object shape(std::string id = {}) const;

 private:
  size_t vertex_count_, face_count_;
  Object shape_;
};

}  // namespace kaustik::v0
