#include "kit/mesh.h"

#include <limits>
#include <map>
#include <tuple>

namespace kaustik::scenes {

uint32_t Mesh::add(const Vec3d& position, const Vec2d& uv) {
  vertices.push_back({position, Vec3d(0.0), uv});
  return uint32_t(vertices.size() - 1);
}

void Mesh::append(const Mesh& other) {
  const auto first = uint32_t(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) triangle(first + a, first + b, first + c);
}

Vec3d Mesh::cross_of(size_t face) const {
  return (corner(face, 1) - corner(face, 0)).cross(corner(face, 2) - corner(face, 0));
}

Mesh moved(Mesh mesh, const Vec3d& offset) {
  for (Vertex& v : mesh.vertices) v.position += offset;
  return mesh;
}

Mesh turned(Mesh mesh, const Vec3d& axis, double degrees) {
  const Vec3d n = axis.normalized();
  const double c = std::cos(degrees * pi_d / 180), s = std::sin(degrees * pi_d / 180);
  const auto turn = [&](const Vec3d& v) {
    return v * c + n.cross(v) * s + n * (n.dot(v) * (1 - c));
  };
  for (Vertex& v : mesh.vertices) {
    v.position = turn(v.position);
    v.normal = turn(v.normal);
  }
  return mesh;
}

Mesh scaled(Mesh mesh, const Vec3d& factors) {
  for (Vertex& v : mesh.vertices) {
    v.position *= factors;
    if (v.normal != Vec3d(0.0)) v.normal = (v.normal / factors).normalized();
  }
  if (factors.x * factors.y * factors.z < 0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

Mesh bent(Mesh mesh, const Map3& map) {
  for (Vertex& v : mesh.vertices) v = {map(v.position), Vec3d(0.0), v.uv};
  return mesh;
}

Mesh turned_inside_out(Mesh mesh) {
  for (Vertex& v : mesh.vertices) v.normal = -v.normal;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

Mesh merged(const std::vector<Mesh>& parts) {
  Mesh all;
  for (const Mesh& part : parts) all.append(part);
  return all;
}

double lowest(const Mesh& mesh) {
  double low = std::numeric_limits<double>::infinity();
  for (const Vertex& v : mesh.vertices) low = std::min(low, v.position.z);
  return low;
}

Mesh subdivided(Mesh mesh) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), 0);
    if (is_new) {
      const Vertex &p = mesh.vertices[it->first.first], &q = mesh.vertices[it->first.second];
      it->second = mesh.add((p.position + q.position) * 0.5, (p.uv + q.uv) * 0.5);
    }
    return it->second;
  };
  for (Vertex& v : mesh.vertices) v.normal = Vec3d(0.0);
  const auto coarse = std::move(mesh.triangles);
  mesh.triangles.clear();
  for (const auto& [a, b, c] : coarse) {
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.triangle(a, ab, ca);
    mesh.triangle(ab, b, bc);
    mesh.triangle(ca, bc, c);
    mesh.triangle(ab, bc, ca);
  }
  return mesh;
}

namespace {

/// Angle of `face` at its corner `k`, by which its normal counts in the vertex's.
double angle_at(const Mesh& mesh, size_t face, int k) {
  const Vec3d at = mesh.corner(face, k);
  const Vec3d a = mesh.corner(face, (k + 1) % 3) - at, b = mesh.corner(face, (k + 2) % 3) - at;
  return std::atan2(a.cross(b).length(), a.dot(b));
}

struct Corner {
  size_t face;
  Vec3d normal;  ///< of the face, unit length
  double angle;
};

/// The corners that meet at each place, by the place's first vertex.
std::vector<std::vector<Corner>> corners_by_place(const Mesh& mesh,
                                                  const std::vector<uint32_t>& place) {
  std::vector<std::vector<Corner>> corners(mesh.vertices.size());
  for (size_t face = 0; face < mesh.triangles.size(); ++face) {
    const Vec3d normal = mesh.cross_of(face).normalized();
    for (int k = 0; k < 3; ++k)
      corners[place[mesh.triangles[face][size_t(k)]]].push_back(
          {face, normal, angle_at(mesh, face, k)});
  }
  return corners;
}

}  // namespace

Mesh displaced(Mesh mesh, const std::function<double(const Vec3d&)>& height) {
  const std::vector<uint32_t> place = welded(mesh);
  const auto corners = corners_by_place(mesh, place);
  std::vector<Vec3d> positions;
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vec3d normal(0.0);
    for (const Corner& corner : corners[place[i]]) normal += corner.normal * corner.angle;
    const Vec3d& p = mesh.vertices[i].position;
    positions.push_back(p + normal.normalized() * height(p));
  }
  for (size_t i = 0; i < positions.size(); ++i)
    mesh.vertices[i] = {positions[i], Vec3d(0.0), mesh.vertices[i].uv};
  return mesh;
}

Mesh shaded(const Mesh& mesh, double crease_degrees) {
  const std::vector<uint32_t> place = welded(mesh);
  const auto corners = corners_by_place(mesh, place);
  const double least_cosine = std::cos(crease_degrees * pi_d / 180) - 1e-9;
  using Key = std::tuple<uint32_t, double, double, int, int, int>;  // place, uv, rounded normal
  std::map<Key, uint32_t> known;
  Mesh out;
  for (size_t face = 0; face < mesh.triangles.size(); ++face) {
    const Vec3d face_normal = mesh.cross_of(face).normalized();
    std::array<uint32_t, 3> triangle;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t index = mesh.triangles[face][k];
      Vec3d sum(0.0);
      for (const Corner& corner : corners[place[index]])
        if (corner.face == face || corner.normal.dot(face_normal) >= least_cosine)
          sum += corner.normal * corner.angle;
      const Vec3d n = sum.normalized();
      const Vertex& v = mesh.vertices[index];
      const Key key{place[index],
                    v.uv.x,
                    v.uv.y,
                    int(std::lround(n.x * 4096)),
                    int(std::lround(n.y * 4096)),
                    int(std::lround(n.z * 4096))};
      const auto [it, is_new] = known.try_emplace(key, uint32_t(out.vertices.size()));
      if (is_new) out.vertices.push_back({v.position, n, v.uv});
      triangle[k] = it->second;
    }
    out.triangles.push_back(triangle);
  }
  return out;
}

Mesh box_mapped(const Mesh& mesh, double metres_per_repeat) {
  std::map<std::pair<uint32_t, int>, uint32_t> known;
  Mesh out;
  for (size_t face = 0; face < mesh.triangles.size(); ++face) {
    const Vec3d n = mesh.cross_of(face);
    const Vec3d size(std::fabs(n.x), std::fabs(n.y), std::fabs(n.z));
    const int axis = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
    std::array<uint32_t, 3> triangle;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t index = mesh.triangles[face][k];
      const auto [it, is_new] = known.try_emplace({index, axis}, uint32_t(out.vertices.size()));
      if (is_new) {
        Vertex v = mesh.vertices[index];
        const Vec3d p = v.position / metres_per_repeat;
        v.uv = axis == 2 ? Vec2d(p.x, p.y) : axis == 1 ? Vec2d(p.x, p.z) : Vec2d(p.y, p.z);
        out.vertices.push_back(v);
      }
      triangle[k] = it->second;
    }
    out.triangles.push_back(triangle);
  }
  return out;
}

std::vector<uint32_t> welded(const Mesh& mesh) {
  std::map<std::array<double, 3>, uint32_t> places;
  std::vector<uint32_t> first;
  for (uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3d p = mesh.vertices[i].position + Vec3d(0.0);  // -0 becomes 0
    first.push_back(places.try_emplace({p.x, p.y, p.z}, i).first->second);
  }
  return first;
}

MeshReport inspect(const Mesh& mesh) {
  MeshReport report;
  const std::vector<uint32_t> place = welded(mesh);
  std::map<std::pair<uint32_t, uint32_t>, int> balance;  // faces on the left minus on the right
  for (size_t face = 0; face < mesh.triangles.size(); ++face) {
    const Vec3d normal = mesh.cross_of(face);
    report.volume += mesh.corner(face, 0).dot(normal) / 6;
    if (!(normal.length() > 1e-12)) ++report.degenerate;
    for (size_t k = 0; k < 3; ++k) {
      const Vertex& v = mesh.vertices[mesh.triangles[face][k]];
      const uint32_t a = place[mesh.triangles[face][k]];
      const uint32_t b = place[mesh.triangles[face][(k + 1) % 3]];
      if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
      for (const double coordinate : {v.uv.x, v.uv.y})
        if (!(coordinate >= 0 && coordinate <= 1)) report.uv_in_range = false;
      if (v.normal.dot(normal) < 0) report.normals_face_outward = false;
    }
  }
  for (const auto& [edge, count] : balance)
    if (count != 0) report.closed = false;
  return report;
}

}  // namespace kaustik::scenes
