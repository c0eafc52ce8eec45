// Normals that are smooth but at creases.

#include <algorithm>
#include <bit>
#include <numbers>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "kaustik/base/sampler.h"
#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/geometry/mesh_surface.h"

namespace kaustik {
namespace {

/// The number of the place of each vertex: the same for all that stand at the same place.
std::vector<uint32_t> places_of(const std::vector<Vec3f>& positions) {
  struct Hash {
    size_t operator()(const std::array<uint32_t, 3>& bits) const {
      return size_t(hash_mix((uint64_t(bits[0]) << 32) | bits[1], bits[2]));
    }
  };
  std::unordered_map<std::array<uint32_t, 3>, uint32_t, Hash> known;
  std::vector<uint32_t> places;
  places.reserve(positions.size());
  for (const Vec3f& p : positions) {
    // 0 has two signs.
    const std::array<uint32_t, 3> bits = {std::bit_cast<uint32_t>(p.x + 0.0f),
                                          std::bit_cast<uint32_t>(p.y + 0.0f),
                                          std::bit_cast<uint32_t>(p.z + 0.0f)};
    places.push_back(known.try_emplace(bits, uint32_t(known.size())).first->second);
  }
  return places;
}

/// Sets of corners that share a normal (Tarjan's union-find, halving paths).
class CornerSets {
 public:
  explicit CornerSets(size_t corners) : parent_(corners) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
  }
  size_t root_of(size_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  /// The lower root stays, so that the result does not depend on the order.
  void unite(size_t a, size_t b) {
    a = root_of(a);
    b = root_of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<size_t> parent_;
};

/// A side of a face, by the places of its ends; `corner` and the next one of its face are they.
struct Side {
  uint32_t low, high;
  size_t corner;
  bool operator<(const Side& other) const {
    return std::tie(low, high, corner) < std::tie(other.low, other.high, other.corner);
  }
};

std::vector<Side> sides_of(const TriangleMesh& mesh, const std::vector<uint32_t>& places) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (size_t face = 0; face < mesh.triangles.size(); ++face)
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t a = places[mesh.triangles[face][i]];
      const uint32_t b = places[mesh.triangles[face][(i + 1) % 3]];
      sides.push_back({std::min(a, b), std::max(a, b), 3 * face + i});
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

size_t next_corner(size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

CornerSets smooth_corners(const TriangleMesh& mesh, double degrees) {
  const std::vector<uint32_t> places = places_of(mesh.positions);
  const auto place_of = [&](size_t corner) {
    return places[mesh.triangles[corner / 3][corner % 3]];
  };
  const auto normal_of = [&](size_t corner) {
    const auto& t = mesh.triangles[corner / 3];
    return triangle_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
  };
  // Some roundings more, so that 0° joins what is flat.
  const auto least_cosine = float(std::cos(degrees * std::numbers::pi / 180) - 1e-6);
  CornerSets sets(3 * mesh.triangles.size());
  const std::vector<Side> sides = sides_of(mesh, places);
  for (size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.low != b.low || a.high != b.high) continue;
    if (dot(normal_of(a.corner), normal_of(b.corner)) < least_cosine) continue;
    const bool same_way = place_of(a.corner) == place_of(b.corner);
    const size_t a_end = next_corner(a.corner), b_end = next_corner(b.corner);
    sets.unite(a.corner, same_way ? b.corner : b_end);
    sets.unite(a_end, same_way ? b_end : b.corner);
  }
  return sets;
}

}  // namespace

TriangleMesh split_at_creases(TriangleMesh mesh, double degrees) {
  const size_t corners = 3 * mesh.triangles.size();
  CornerSets sets = smooth_corners(mesh, degrees);
  std::vector<Vec3f> sums(corners, Vec3f(0, 0, 0));  // at the roots
  for (size_t face = 0; face < mesh.triangles.size(); ++face) {
    const std::array<Vec3f, 3> parts = weighted_normals(mesh, mesh.triangles[face]);
    for (size_t i = 0; i < 3; ++i) sums[sets.root_of(3 * face + i)] += parts[i];
  }

  // A vertex becomes as many as there are sets of corners around it.
  std::vector<std::array<size_t, 3>> uses;  // vertex, root, corner
  uses.reserve(corners);
  for (size_t corner = 0; corner < corners; ++corner)
    uses.push_back({mesh.triangles[corner / 3][corner % 3], sets.root_of(corner), corner});
  std::sort(uses.begin(), uses.end());
  TriangleMesh split;
  split.triangles = std::move(mesh.triangles);
  for (size_t i = 0; i < uses.size(); ++i) {
    const auto [vertex, root, corner] = uses[i];
    if (i == 0 || uses[i - 1][0] != vertex || uses[i - 1][1] != root) {
      split.positions.push_back(mesh.positions[vertex]);
      if (!mesh.uvs.empty()) split.uvs.push_back(mesh.uvs[vertex]);
      const float sum = length(sums[root]);
      split.normals.push_back(sum > 0 ? sums[root] * (1.0f / sum) : Vec3f(0, 0, 1));
    }
    split.triangles[corner / 3][corner % 3] = uint32_t(split.positions.size() - 1);
  }
  return split;
}

}  // namespace kaustik
