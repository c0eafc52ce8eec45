#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "kaustik/loader/pbrt/shapes.h"

namespace kaustik::pbrt {
namespace {

using Faces = std::vector<std::array<int32_t, 3>>;

/// Around a vertex in order; of one on a border from one end of it to the other.
struct Ring {
  std::vector<int32_t> neighbours;
  bool is_border = false;
};

uint64_t edge_key(int32_t a, int32_t b) {
  return uint64_t(uint32_t(std::min(a, b))) << 32 | uint32_t(std::max(a, b));
}

/// The rings of all vertices. Where a mesh is no surface (three faces at an edge, two sheets at a
/// vertex) a ring is what can be followed.
std::vector<Ring> rings_of(const Faces& faces, size_t vertices) {
  // For each vertex the edges opposite to it: from one neighbour to the next.
  std::vector<std::vector<std::pair<int32_t, int32_t>>> opposite(vertices);
  for (const auto& face : faces)
    for (size_t i = 0; i < 3; ++i)
      opposite[size_t(face[i])].emplace_back(face[(i + 1) % 3], face[(i + 2) % 3]);
  std::vector<Ring> rings(vertices);
  for (size_t v = 0; v < vertices; ++v) {
    const auto& edges = opposite[v];
    if (edges.empty()) continue;
    std::unordered_map<int32_t, int32_t> next, before;
    for (const auto& [a, b] : edges) next.emplace(a, b), before.emplace(b, a);
    int32_t start = edges.front().first;
    for (const auto& edge : edges)
      if (!before.contains(edge.first)) start = edge.first, rings[v].is_border = true;
    Ring& ring = rings[v];
    for (int32_t at = start; ring.neighbours.size() <= edges.size();) {
      ring.neighbours.push_back(at);
      const auto found = next.find(at);
      if (found == next.end() || (at = found->second) == start) break;
    }
  }
  return rings;
}

Vec3d border_mean(const std::vector<Vec3d>& points, const Ring& ring) {
  return (points[size_t(ring.neighbours.front())] + points[size_t(ring.neighbours.back())]) * 0.5;
}

Vec3d ring_sum(const std::vector<Vec3d>& points, const Ring& ring) {
  Vec3d sum(0, 0, 0);
  for (const int32_t neighbour : ring.neighbours) sum += points[size_t(neighbour)];
  return sum;
}

/// Weight of each neighbour of an inner vertex (Warren's choice).
double beta(size_t valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8 * double(valence)); }

Vec3d moved(const std::vector<Vec3d>& points, size_t vertex, const Ring& ring) {
  const Vec3d& own = points[vertex];
  if (ring.neighbours.size() < 2) return own;
  if (ring.is_border) return own * 0.75 + border_mean(points, ring) * 0.25;
  const double weight = beta(ring.neighbours.size());
  return own * (1 - weight * double(ring.neighbours.size())) + ring_sum(points, ring) * weight;
}

Vec3d limit(const std::vector<Vec3d>& points, size_t vertex, const Ring& ring) {
  const Vec3d& own = points[vertex];
  if (ring.neighbours.size() < 2) return own;
  if (ring.is_border) return own * 0.6 + border_mean(points, ring) * 0.4;
  const size_t valence = ring.neighbours.size();
  const double weight = 1 / (double(valence) + 3 / (8 * beta(valence)));
  return own * (1 - weight * double(valence)) + ring_sum(points, ring) * weight;
}

/// By the tangents at the limit (Hoppe et al., "Piecewise Smooth Surface Reconstruction", 1994).
Vec3d limit_normal(const std::vector<Vec3d>& points, size_t vertex, const Ring& ring) {
  const auto at = [&](size_t i) { return points[size_t(ring.neighbours[i])]; };
  const size_t count = ring.neighbours.size();
  if (count < 2) return {0, 0, 0};
  Vec3d s(0, 0, 0), t(0, 0, 0);
  if (!ring.is_border) {
    for (size_t i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * double(i) / double(count);
      s += at(i) * std::cos(angle);
      t += at(i) * std::sin(angle);
    }
    return s.cross(t);
  }
  s = at(count - 1) - at(0);
  const Vec3d& own = points[vertex];
  if (count == 2) {
    t = at(0) + at(1) - own * 2;
  } else if (count == 3) {
    t = at(1) - own;
  } else if (count == 4) {
    t = at(0) * -1 + at(1) * 2 + at(2) * 2 + at(3) * -1 + own * -2;
  } else {
    const double theta = std::numbers::pi / double(count - 1);
    t = (at(0) + at(count - 1)) * std::sin(theta);
    for (size_t i = 1; i + 1 < count; ++i)
      t += at(i) * ((2 * std::cos(theta) - 2) * std::sin(double(i) * theta));
    t = -t;
  }
  return t.cross(s);
}

struct Surface {
  std::vector<Vec3d> points;
  Faces faces;
};

Surface divided(const Surface& coarse) {
  const std::vector<Ring> rings = rings_of(coarse.faces, coarse.points.size());
  Surface fine;
  fine.points.reserve(4 * coarse.points.size());
  for (size_t v = 0; v < coarse.points.size(); ++v)
    fine.points.push_back(moved(coarse.points, v, rings[v]));
  // The vertices opposite to an edge: two inside, one at a border.
  struct Edge {
    int32_t opposite[2] = {-1, -1};
    int32_t vertex = -1;
  };
  std::unordered_map<uint64_t, Edge> edges;
  for (const auto& face : coarse.faces)
    for (size_t i = 0; i < 3; ++i) {
      Edge& edge = edges[edge_key(face[i], face[(i + 1) % 3])];
      edge.opposite[edge.opposite[0] < 0 ? 0 : 1] = face[(i + 2) % 3];
    }
  const auto on_edge = [&](int32_t a, int32_t b) {
    Edge& edge = edges[edge_key(a, b)];
    if (edge.vertex >= 0) return edge.vertex;
    const Vec3d ends = coarse.points[size_t(a)] + coarse.points[size_t(b)];
    fine.points.push_back(edge.opposite[1] < 0
                              ? ends * 0.5
                              : ends * 0.375 + (coarse.points[size_t(edge.opposite[0])] +
                                                coarse.points[size_t(edge.opposite[1])]) *
                                                   0.125);
    return edge.vertex = int32_t(fine.points.size() - 1);
  };
  fine.faces.reserve(4 * coarse.faces.size());
  for (const auto& [a, b, c] : coarse.faces) {
    const int32_t ab = on_edge(a, b), bc = on_edge(b, c), ca = on_edge(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace

MeshParts subdivided(const std::vector<float>& positions, const std::vector<int32_t>& faces,
                     int levels) {
  Surface surface;
  for (size_t i = 0; i + 2 < positions.size(); i += 3)
    surface.points.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  for (size_t i = 0; i + 2 < faces.size(); i += 3)
    surface.faces.push_back({faces[i], faces[i + 1], faces[i + 2]});
  for (int level = 0; level < levels; ++level) surface = divided(surface);
  const std::vector<Ring> rings = rings_of(surface.faces, surface.points.size());
  MeshParts mesh;
  std::vector<Vec3d> limits;
  limits.reserve(surface.points.size());
  for (size_t v = 0; v < surface.points.size(); ++v)
    limits.push_back(limit(surface.points, v, rings[v]));
  for (size_t v = 0; v < limits.size(); ++v) {
    const Vec3d normal = limit_normal(limits, v, rings[v]);
    mesh.positions.insert(mesh.positions.end(),
                          {float(limits[v].x), float(limits[v].y), float(limits[v].z)});
    mesh.normals.insert(mesh.normals.end(), {float(normal.x), float(normal.y), float(normal.z)});
  }
  mesh.faces.reserve(3 * surface.faces.size());
  for (const auto& face : surface.faces)
    mesh.faces.insert(mesh.faces.end(), face.begin(), face.end());
  return mesh;
}

}  // namespace kaustik::pbrt
