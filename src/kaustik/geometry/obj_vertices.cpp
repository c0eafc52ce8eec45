#include "kaustik/geometry/obj_vertices.h"

namespace kaustik {

void ObjVertices::reserve(size_t vertices) {
  for (UnsetVector<uint32_t>* numbers : {&positions_, &uvs_, &normals_})
    reserve_large(*numbers, vertices);
}

uint32_t ObjVertices::vertex_of(const ObjCorner& corner) {
  const auto next = uint32_t(size());
  uint32_t& first = first_[corner.position];
  uint32_t vertex = next;
  if (first == ObjCorner::none)
    first = next;
  else if (corner_of(first) == corner)
    vertex = first;
  else
    vertex = others_.number_of(corner, next, [&](uint32_t known) { return corner_of(known); });
  if (vertex != next) return vertex;
  positions_.push_back(corner.position);
  uvs_.push_back(corner.uv);
  normals_.push_back(corner.normal);
  return vertex;
}

void ObjVertices::finish() {
  first_ = UnsetVector<uint32_t>();
  others_ = ObjCornerTable();
}

}  // namespace kaustik
