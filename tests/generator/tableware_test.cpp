#include <gtest/gtest.h>

#include "kit/gem.h"
#include "kit/glassware.h"
#include "kit/provisions.h"

namespace kaustik::scenes {
namespace {

void expect_solid(const std::string& name, const Mesh& mesh) {
  const MeshReport report = inspect(mesh);
  EXPECT_TRUE(report.closed) << name;
  EXPECT_GT(report.volume, 0) << name;
  EXPECT_EQ(report.degenerate, 0u) << name;
  EXPECT_TRUE(report.uv_in_range) << name;
  EXPECT_TRUE(report.normals_face_outward) << name;
  EXPECT_NEAR(lowest(mesh), 0, 1e-6) << name;
}

double volume(const Mesh& mesh) { return inspect(mesh).volume; }

double reach(const Mesh& mesh, double z) {
  double farthest = 0;
  for (const Vertex& v : mesh.vertices)
    if (std::fabs(v.position.z - z) < 0.002)
      farthest = std::max(farthest, std::hypot(v.position.x, v.position.y));
  return farthest;
}

TEST(Tableware, SolidsAreClosedFaceOutwardAndStandOnTheTable) {
  expect_solid("decanter", decanter(0.12).glass);
  expect_solid("wine glass", wine_glass(0.11).glass);
  expect_solid("cup", fluted_cup(12));
  const Pear p = pear(1);
  expect_solid("pear", p.flesh);
  expect_solid("lemon", lemon(1));
  const Book b = book(0.2, 0.14, 0.03);
  expect_solid("book", b.cover);
  EXPECT_TRUE(inspect(p.stalk).closed);
  EXPECT_TRUE(inspect(b.pages).closed);
  EXPECT_TRUE(inspect(b.gilding).closed);
}

TEST(Tableware, LiquidsReachIntoTheWallAndNotThroughIt) {
  for (const double level : {0.09, 0.12}) {
    const Vessel vessel = decanter(level);
    EXPECT_TRUE(inspect(vessel.liquid).closed);
    EXPECT_TRUE(inspect(vessel.liquid).normals_face_outward);
    EXPECT_LT(reach(vessel.liquid, 0.05), reach(vessel.glass, 0.05) - 0.001);
    EXPECT_GT(volume(vessel.liquid), 0.0004);  // m3
    EXPECT_LT(volume(vessel.liquid), 0.0010);
  }
}

TEST(Tableware, AFillingHasItsLevelAndItsVolume) {
  const Curve beaker = {{0, 0.01}, {0.03, 0.01}, {0.03, 0.05}, {0.03, 0.10}};
  constexpr double radius = 0.03, overlap = 0.001;
  const Mesh flat = filling(beaker, 0.06, overlap, 1e-4, 128);
  EXPECT_TRUE(inspect(flat).closed);
  EXPECT_NEAR(volume(flat) / (pi_d * radius * radius * 0.05), 1.08, 0.02);
  const Mesh curved = filling(beaker, 0.06, overlap, 0.001, 128);
  double top = 0;
  for (const Vertex& v : curved.vertices) top = std::max(top, v.position.z);
  EXPECT_NEAR(top, 0.061, 1e-9);
}

TEST(Brilliant, HasItsFacetsAtTheirAngles) {
  const BrilliantCut cut;
  const Mesh stone = brilliant(0.02, cut);
  const MeshReport report = inspect(stone);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.degenerate, 0u);
  EXPECT_TRUE(report.normals_face_outward);
  // A brilliant of one carat (0.2 g of 3520 kg/m3) is 6.5 mm across.
  EXPECT_NEAR(report.volume / std::pow(0.02, 3), 0.0002 / 3520 / std::pow(0.0065, 3), 0.005);

  std::vector<Vec3d> facets;
  int crown = 0, pavilion = 0;
  for (size_t face = 0; face < stone.triangles.size(); ++face) {
    const Vec3d n = stone.cross_of(face).normalized();
    const auto same = [&](const Vec3d& other) { return (other - n).length() < 1e-9; };
    if (std::any_of(facets.begin(), facets.end(), same)) continue;
    facets.push_back(n);
    const double degrees = std::acos(std::clamp(n.z, -1.0, 1.0)) * 180 / pi_d;
    if (std::fabs(degrees - cut.crown_degrees) < 1e-6) ++crown;
    if (std::fabs(180 - degrees - cut.pavilion_degrees) < 1e-6) ++pavilion;
  }
  EXPECT_EQ(facets.size(), 57u + 16u);
  EXPECT_EQ(crown, 8);
  EXPECT_EQ(pavilion, 8);
}

}  // namespace
}  // namespace kaustik::scenes
