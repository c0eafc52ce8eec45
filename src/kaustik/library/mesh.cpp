#include "kaustik/mesh.h"

#include "kaustik/library/access.h"
#include "kaustik/library/boundary.h"

namespace kaustik::v0 {
namespace {

template <typename T>
Array rows_of(const Rows<T>& rows, size_t columns) {
  return Array::copy(rows.data, rows.count, columns, rows.stride_bytes);
}

}  // namespace

Mesh::Mesh(const MeshBuffers& buffers)
    : vertex_count_(buffers.positions.count),
      face_count_(buffers.faces.count),
      shape_("shape", "mesh") {
  if (vertex_count_ == 0 || face_count_ == 0)
    throw wrong_input("a mesh has no vertices or no faces",
                      "give it positions of at least three vertices, and faces");
  shape_.set("positions", rows_of(buffers.positions, 3)).set("faces", rows_of(buffers.faces, 3));
  if (buffers.normals.count > 0) shape_.set("normals", rows_of(buffers.normals, 3));
  if (buffers.uv.count > 0) shape_.set("uv", rows_of(buffers.uv, 2));
}

Object Mesh::shape(std::string id) const {
  Object shape = shape_;
  details::Access::rename(shape, std::move(id));
  return shape;
}

}  // namespace kaustik::v0
