// Compiled meshes (.rtm): patches of up to 256 corners, and triangles within and between them.

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/compiled_reader.h"

namespace kaustik::radiance {
namespace {

constexpr size_t most_corners = 256;
constexpr double one_turn = 4294967296.0;  ///< 2³²: coordinates are shares of the cube

/// A direction by the signs of its axes and the smaller two of its coordinates, 13 bits each; the
/// flags say which these are.
Vec3f direction_of(uint32_t code) {
  if (code == 0) return {0, 0, 0};
  constexpr double step = 11585.2;
  const double first = ((code >> 5 & 0x1fff) + 0.5) / step;
  const double second = ((code >> 18 & 0x1fff) + 0.5) / step;
  const double third = std::sqrt(std::max(0.0, 1 - first * first - second * second));
  const int first_axis = (code & 8) != 0 ? 0 : 1;
  const int second_axis = (code & 16) != 0 ? 2 : 1 - first_axis;
  auto found = Vec3f(Vec3d(third, third, third));
  found[first_axis] = float(first);
  found[second_axis] = float(second);
  for (int axis = 0; axis < 3; ++axis)
    if ((code >> axis & 1) != 0) found[axis] = -found[axis];
  return found;
}

class MeshReader {
 public:
  MeshReader(std::string_view bytes, const Place& place) : reader_(bytes, place) {}

  CompiledMesh read() {
    constexpr int magic = 319;  // of format 1
    reader_.read_format(magic);
    reader_.read_cube(corner_, size_);
    for (int axis = 0; axis < 2; ++axis) {
      low_[axis] = reader_.number();
      high_[axis] = reader_.number();
    }
    reader_.skip_tree();
    mesh_.materials = reader_.read_objects();
    const size_t patches = reader_.count(4, 13);
    for (size_t i = 0; i < patches; ++i) read_patch();
    connect();
    return std::move(mesh_);
  }

 private:
  void read_patch() {
    const int64_t flags = reader_.integer(1);
    if ((flags & 1) == 0 || (flags & ~7) != 0) reader_.refuse();
    const size_t n = reader_.count(2, 12);
    if (n == 0 || n > most_corners) reader_.refuse();
    const auto patch = uint32_t(starts_.size());
    const size_t start = mesh_.corners.size();
    starts_.push_back(start);
    mesh_.corners.resize(start + n);
    const auto share = [&] { return (double(uint32_t(reader_.integer(4))) + 0.5) / one_turn; };
    for (size_t i = start; i < start + n; ++i)
      for (int axis = 0; axis < 3; ++axis)
        mesh_.corners[i].position[axis] = float(corner_[axis] + size_ * share());
    if ((flags & 2) != 0)
      for (size_t i = start; i < start + n; ++i)
        mesh_.corners[i].normal = direction_of(uint32_t(reader_.integer(4)));
    if ((flags & 4) != 0)
      for (size_t i = start; i < start + n; ++i) {
        mesh_.corners[i].u = float(low_[0] + (high_[0] - low_[0]) * share());
        mesh_.corners[i].v = float(low_[1] + (high_[1] - low_[1]) * share());
      }
    read_triangles(patch);
  }

  /// Their corners by 256 times the number of the patch plus the number within it.
  void read_triangles(uint32_t patch) {
    const auto own = [&] { return patch << 8 | (uint32_t(reader_.integer(1)) & 0xff); };
    const auto other = [&] { return uint32_t(reader_.integer(4)); };
    std::vector<CompiledMesh::Triangle>& all = mesh_.triangles;
    const size_t first = all.size();
    for (size_t left = reader_.count(2, 3); left > 0; --left) {
      const uint32_t a = own(), b = own();
      all.push_back({{a, b, own()}, -1});
    }
    const bool have_several = reader_.integer(2) > 1;
    auto material = have_several ? int32_t{-1} : int32_t(reader_.integer(2));
    for (size_t i = first; i < all.size(); ++i) {
      if (have_several) material = int32_t(reader_.integer(2));
      all[i].material = material;
    }
    for (size_t left = reader_.count(2, 8); left > 0; --left) {
      const uint32_t a = other(), b = own(), c = own();
      all.push_back({{a, b, c}, int32_t(reader_.integer(2))});
    }
    for (size_t left = reader_.count(2, 11); left > 0; --left) {
      const uint32_t a = other(), b = other(), c = own();
      all.push_back({{a, b, c}, int32_t(reader_.integer(2))});
    }
  }

  /// Puts numbers of corners in place of the patches', which may be those of later ones.
  void connect() {
    for (CompiledMesh::Triangle& triangle : mesh_.triangles) {
      for (uint32_t& corner : triangle.corners) {
        const size_t patch = corner >> 8;
        if (patch >= starts_.size()) reader_.refuse();
        const size_t found = starts_[patch] + (corner & 0xff);
        if (found >= (patch + 1 < starts_.size() ? starts_[patch + 1] : mesh_.corners.size()))
          reader_.refuse();
        corner = uint32_t(found);
      }
      if (triangle.material >= int64_t(mesh_.materials.size())) reader_.refuse();
    }
  }

  CompiledReader reader_;
  CompiledMesh mesh_;
  Vec3d corner_;
  double size_ = 0, low_[2] = {}, high_[2] = {};
  std::vector<size_t> starts_;  ///< the first corner of each patch
};

}  // namespace

CompiledMesh read_compiled_mesh(std::string_view bytes, const Place& place) {
  return MeshReader(bytes, place).read();
}

}  // namespace kaustik::radiance
