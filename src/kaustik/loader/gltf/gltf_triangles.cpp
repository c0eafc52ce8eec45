#include "kaustik/loader/gltf/gltf_triangles.h"

#include <vector>

namespace kaustik::gltf {
namespace {

/// `index` gives the i-th of `count` indices. Each second triangle of a strip runs the other way.
template <typename Index>
std::shared_ptr<const Array> assembled(size_t count, Topology topology, const Index& index) {
  const size_t triangles = topology == Topology::triangles ? count / 3 : count < 3 ? 0 : count - 2;
  std::vector<uint32_t> faces;
  faces.reserve(3 * triangles);
  for (size_t i = 0; i < triangles; ++i) {
    size_t corners[3] = {3 * i, 3 * i + 1, 3 * i + 2};
    if (topology == Topology::strip) {
      corners[0] = i;
      corners[1] = i + 1 + i % 2;
      corners[2] = i + 2 - i % 2;
    } else if (topology == Topology::fan) {
      corners[0] = 0;
      corners[1] = i + 1;
      corners[2] = i + 2;
    }
    for (const size_t corner : corners) faces.push_back(uint32_t(index(corner)));
  }
  return Array::of<uint32_t>({triangles, 3}, std::move(faces));
}

}  // namespace

std::shared_ptr<const Array> triangles_of(const std::shared_ptr<const Array>& indices,
                                          size_t vertices, Topology topology) {
  if (!indices) return assembled(vertices, topology, [](size_t i) { return i; });
  const size_t count = indices->count();
  if (topology == Topology::triangles)
    return Array::borrow(indices->type(), {count / 3, 3},
                         indices->bytes().first(count / 3 * 3 * element_size(indices->type())),
                         indices);
  return indices->visit([&](auto values) {
    return assembled(count, topology, [&](size_t i) { return size_t(values[i]); });
  });
}

}  // namespace kaustik::gltf
