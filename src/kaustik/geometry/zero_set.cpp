#include "kaustik/geometry/zero_set.h"

#include "kaustik/geometry/shape_support.h"

namespace kaustik {
namespace {

/// Triangles of the zero set in a tetrahedron, facing the positive side.
void add_tetrahedron(const Vec3d (&p)[4], const double (&value)[4], std::vector<Vec3d>& corners) {
  int inside[4], outside[4], n_inside = 0, n_outside = 0;
  for (int i = 0; i < 4; ++i) (value[i] < 0 ? inside[n_inside++] : outside[n_outside++]) = i;
  if (n_inside == 0 || n_outside == 0) return;
  const auto crossing = [&](int a, int b) {
    const double s = value[a] / (value[a] - value[b]);
    return p[a] + (p[b] - p[a]) * s;
  };
  const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const bool faces_outside = (b - a).cross(c - a).dot(p[outside[0]] - a) > 0;
    corners.insert(corners.end(), {a, faces_outside ? b : c, faces_outside ? c : b});
  };
  if (n_inside == 2) {
    const Vec3d a = crossing(inside[0], outside[0]), b = crossing(inside[0], outside[1]);
    const Vec3d c = crossing(inside[1], outside[1]), d = crossing(inside[1], outside[0]);
    add(a, b, c);
    add(a, c, d);
    return;
  }
  const int single = n_inside == 1 ? inside[0] : outside[0];
  const int* others = n_inside == 1 ? outside : inside;
  add(crossing(single, others[0]), crossing(single, others[1]), crossing(single, others[2]));
}

}  // namespace

TriangleMesh zero_set(const std::function<double(const Vec3d&)>& value, const Vec3d& low,
                      const Vec3d& high, int cells, const Transform& world_from_field) {
  const Vec3d width = (high - low) / double(cells);
  const auto grid_point = [&](int i, int j, int k) { return low + Vec3d(i, j, k) * width; };
  const auto layer = [&](int k) {
    std::vector<double> values;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) values.push_back(value(grid_point(i, j, k)));
    return values;
  };
  // The six tetrahedra round the diagonal from corner 0 to corner 7 (bits: x, y, z).
  constexpr int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                    {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  std::vector<Vec3d> corners;
  std::vector<double> below = layer(0);
  for (int k = 0; k < cells; ++k) {
    std::vector<double> above = layer(k + 1);
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i)
        for (const auto& tetrahedron : tetrahedra) {
          Vec3d p[4];
          double values[4];
          for (int c = 0; c < 4; ++c) {
            const int x = i + (tetrahedron[c] & 1), y = j + (tetrahedron[c] >> 1 & 1);
            const int z = tetrahedron[c] >> 2;
            p[c] = grid_point(x, y, k + z);
            values[c] = (z ? above : below)[size_t(y) * size_t(cells + 1) + size_t(x)];
          }
          add_tetrahedron(p, values, corners);
        }
    below = std::move(above);
  }
  TriangleMesh mesh;
  const bool mirrored = world_from_field.determinant3() < 0;
  for (size_t i = 0; i < corners.size(); i += 3) {
    for (size_t c = 0; c < 3; ++c)
      mesh.positions.push_back(Vec3f(transform_point(world_from_field, corners[i + c])));
    const auto a = uint32_t(i);
    mesh.triangles.push_back(mirrored ? std::array{a, a + 2, a + 1} : std::array{a, a + 1, a + 2});
  }
  return mesh;
}

double mesh_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& corner : mesh.triangles) {
    const Vec3d p(mesh.positions[corner[0]]);
    sum +=
        0.5 *
        (Vec3d(mesh.positions[corner[1]]) - p).cross(Vec3d(mesh.positions[corner[2]]) - p).length();
  }
  return sum;
}

}  // namespace kaustik
