#include <gtest/gtest.h>

#include <fmt/format.h>

#include "kit/field.h"
#include "kit/surface.h"
#include "kit/sweep.h"

namespace kaustik::scenes {
namespace {

struct Solid {
  std::string name;
  Mesh mesh;
  double volume;     ///< of the ideal solid, m³
  double tolerance;  ///< relative; flat facets lose some of a curved one
};

const Curve l_shape = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};

Path ring_path(double radius, int points) {
  Path path;
  for (const Vec2d& p : circle(radius, points)) path.emplace_back(p.x, p.y, 0);
  return path;
}

std::vector<Solid> solids() {
  const double ball_volume = 4 * pi_d / 3;
  SweepOptions closed, tapered;
  closed.closed_path = true;
  tapered.scale = [](double share) { return 1 - 0.5 * share; };
  const Field unit_ball = [](const Vec3d& p) { return distance_to_ball(p, {0, 0, 0}, 1); };
  return {
      {"box", box({0, 0, 0}, {1, 2, 3}), 6, 1e-12},
      {"bevelled box", bevelled_box({-1, 0, 2}, {1, 3, 4}, 0.01, 3), 12, 1e-3},
      {"cylinder", cylinder(1, -1, 2, 64), 3 * pi_d, 2e-3},
      {"cone", cone(1, 0, 0, 3, 64), pi_d, 2e-3},
      {"upside-down cone", cone(0, 1, 0, 3, 64), pi_d, 2e-3},
      {"ball", ball({5, 5, 5}, 1, 64), ball_volume, 6e-3},
      {"torus", torus(2, 0.5, 64, 32), 2 * pi_d * pi_d * 2 * 0.25, 1e-2},
      {"crystal", crystal(1, 2, 1, 8), 3.680, 1e-3},
      {"extruded L", extruded(l_shape, -1, 1), 8, 1e-12},
      {"straight sweep", swept(rectangle(1, 2), {{0, 0, 0}, {3, 4, 0}}, {0, 0, 1}), 10, 1e-12},
      {"mitred corner", swept(rectangle(1, 1), {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}}, {0, 0, 1}), 10,
       1e-9},
      {"closed sweep", swept(circle(0.2, 32), ring_path(2, 64), {0, 0, 1}, closed),
       pi_d * 0.04 * 4 * pi_d, 1e-2},
      {"tapered tube", tube(1, {{0, 0, 0}, {0, 0, 3}}, 64, tapered), pi_d * 1.75, 3e-3},
      {"winding tube", tube(0.1, smooth_path({{0, 0, 0}, {1, 0, 1}, {1, 1, 2}, {0, 1, 3}}, 8), 24),
       pi_d * 0.01 * 4.3, 0.05},
      {"frame", frame({{0, 0}, {0.1, 0}, {0.1, 0.05}, {0, 0.05}}, 1, 2), 2 * 0.005 * 3.2, 1e-9},
      {"height field", height_field({0, 0}, {2, 1}, 20, 10, -1, [](double x, double) { return x; }),
       4, 1e-9},
      {"thick sheet", thick_sheet(4, 4, 0.1, [](double u, double v) { return Vec3d(u, v, 0); }),
       0.1, 1e-9},
      {"leaf", leaf(0.3, 0.1, 0.3, 0.8), 0.3 * 0.1 * 0.62 * 0.0006, 0.2},
      {"curtain", curtain(2, 2, 5, 0.05), 0.001 * 2 * 2.2, 0.1},
      {"contoured ball", contoured(unit_ball, Vec3d(-1.3), Vec3d(1.3), 0.05), ball_volume, 5e-3},
      {"subdivided box", subdivided(subdivided(box({0, 0, 0}, {1, 1, 1}))), 1, 1e-12},
      {"displaced ball", displaced(ball({0, 0, 0}, 1, 64), [](const Vec3d&) { return 1.0; }),
       8 * ball_volume, 6e-3},
      {"mirrored ball", scaled(ball({0, 0, 0}, 1, 64), {-1, 2, 1}), 2 * ball_volume, 6e-3},
      {"turned box", turned(box({0, 0, 0}, {1, 1, 1}), {1, 2, 3}, 50), 1, 1e-12},
  };
}

TEST(Mesh, SolidsAreClosedFaceOutwardAndHaveTheirVolume) {
  for (const Solid& solid : solids()) {
    const MeshReport report = inspect(solid.mesh);
    EXPECT_TRUE(report.closed) << solid.name;
    EXPECT_NEAR(report.volume, solid.volume, solid.tolerance * solid.volume) << solid.name;
    EXPECT_EQ(report.degenerate, 0u) << solid.name;
    EXPECT_TRUE(report.uv_in_range) << solid.name;
    EXPECT_TRUE(report.normals_face_outward) << solid.name;
  }
}

TEST(Mesh, InspectFindsPlantedFaults) {
  Mesh open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  EXPECT_FALSE(inspect(open).closed);

  Mesh one_flipped = box({0, 0, 0}, {1, 1, 1});
  std::swap(one_flipped.triangles[0][0], one_flipped.triangles[0][1]);
  EXPECT_FALSE(inspect(one_flipped).closed);
  EXPECT_FALSE(inspect(one_flipped).normals_face_outward);

  Mesh inside_out = turned_inside_out(box({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(inspect(inside_out).closed);
  EXPECT_LT(inspect(inside_out).volume, 0);

  Mesh thin = box({0, 0, 0}, {1, 1, 1});
  thin.triangles.push_back({0, 0, 1});
  EXPECT_EQ(inspect(thin).degenerate, 1u);

  Mesh off = box({0, 0, 0}, {1, 1, 1});
  off.vertices[0].uv.x = 1.5;
  EXPECT_FALSE(inspect(off).uv_in_range);
}

TEST(Mesh, ShadingSplitsVerticesAlongCreasesOnly) {
  Mesh cube = box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(shaded(cube, 30).vertices.size(), 24u);
  for (Vertex& v : cube.vertices) v.uv = {0, 0};
  const Mesh round = shaded(cube, 180);
  EXPECT_EQ(round.vertices.size(), 8u);
  const double diagonal = 1 / std::sqrt(3.0);
  EXPECT_NEAR(round.vertices[0].normal.dot((round.vertices[0].position - Vec3d(0.5)).normalized()),
              1, 1e-9);
  EXPECT_NEAR(std::fabs(round.vertices[0].normal.x), diagonal, 1e-9);
}

TEST(Mesh, NormalsOfABallPointFromItsCentre) {
  const Mesh mesh = ball({1, 2, 3}, 0.5, 96);
  for (const Vertex& v : mesh.vertices)
    EXPECT_GT(v.normal.dot((v.position - Vec3d(1, 2, 3)).normalized()), 0.9999);
}

TEST(Mesh, BoxMappingGivesMetresOnEveryFace) {
  const Mesh mesh = box_mapped(bevelled_box({0, 0, 0}, {2, 3, 4}, 0.1), 0.5);
  for (size_t face = 0; face < mesh.triangles.size(); ++face) {
    const Vec3d n = mesh.cross_of(face);
    if (n.normalized().z < 0.999) continue;
    for (const uint32_t i : mesh.triangles[face]) {
      EXPECT_DOUBLE_EQ(mesh.vertices[i].uv.x, mesh.vertices[i].position.x / 0.5);
      EXPECT_DOUBLE_EQ(mesh.vertices[i].uv.y, mesh.vertices[i].position.y / 0.5);
    }
  }
  EXPECT_TRUE(inspect(mesh).closed);
}

TEST(Sweep, TriangulationCoversThePolygonOnce) {
  double area = 0;
  for (const auto& [a, b, c] : triangulated(l_shape))
    area += 0.5 * (l_shape[b] - l_shape[a]).cross(l_shape[c] - l_shape[a]);
  EXPECT_DOUBLE_EQ(area, 4);
}

TEST(Sweep, BadInputIsRefused) {
  EXPECT_THROW(triangulated({{0, 0}, {0, 1}, {1, 1}, {1, 0}}), std::invalid_argument);  // clockwise
  EXPECT_THROW(swept(rectangle(1, 1), {{0, 0, 0}}, {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(revolved({{1, 0}, {1, 1}}, 8), std::invalid_argument);  // not on the axis
  EXPECT_THROW(contoured([](const Vec3d& p) { return p.length() - 2; }, Vec3d(-1), Vec3d(1), 0.1),
               std::invalid_argument);
}

}  // namespace
}  // namespace kaustik::scenes
