#include <gtest/gtest.h>

#include "kit/architecture.h"
#include "kit/furniture.h"

namespace kaustik::scenes {
namespace {

double area_facing_up(const Mesh& mesh) {
  double area = 0;
  for (size_t face = 0; face < mesh.triangles.size(); ++face) {
    const Vec3d n = mesh.cross_of(face);
    if (n.z > 0.99 * n.length()) area += 0.5 * n.z;
  }
  return area;
}

/// Boards cover the floor but for their gaps and chamfers, and none lies on another.
TEST(Floors, BoardsCoverTheFloorOnce) {
  const double length = 0.5, width = 0.1, inset = 0.0018;  // gap and chamfer, on either side
  const double share = (1 - 2 * inset / length) * (1 - 2 * inset / width);
  const Vec2d low(-1.3, -2), high(1.2, 2.5);
  for (const bool herringbone : {true, false}) {
    const auto boards = herringbone ? herringbone_floor(low, high, length, width, 3, 1)
                                    : board_floor(low, high, length, width, 3, 1);
    double area = 0;
    for (const Mesh& mesh : boards) {
      area += area_facing_up(mesh);
      EXPECT_TRUE(inspect(mesh).closed);
      EXPECT_EQ(inspect(mesh).degenerate, 0u);
    }
    const double floor = 2.5 * 4.5;
    EXPECT_NEAR(area, share * floor, 0.012 * floor) << herringbone;  // boards cut by the walls
  }
}

TEST(Walls, OpeningsTakeTheirVolumeAway) {
  const Mesh wall = wall_with_openings(5, 3, 0.3, {{1, 0, 1, 2}, {3, 1, 1.5, 1.2}});
  EXPECT_NEAR(inspect(wall).volume, 0.3 * (15 - 2 - 1.8), 1e-9);
}

TEST(Furniture, IsClosedAndFacesOutward) {
  const BentwoodChair chair = bentwood_chair();
  const PottedPlant plant = potted_plant(1.5, 12, 3);
  const FoldingScreen screen = folding_screen(3, 0.6, 1.8, 25);
  const Bench seat = bench(1.6, 0.5, 0.45);
  const std::pair<const char*, const Mesh*> parts[] = {
      {"chair", &chair.wood},   {"cane", &chair.cane},    {"pot", &plant.pot},
      {"earth", &plant.earth},  {"stems", &plant.stems},  {"leaves", &plant.leaves},
      {"frame", &screen.frame}, {"cloth", &screen.cloth}, {"hinges", &screen.hinges},
      {"seat", &seat.seat},     {"legs", &seat.legs}};
  for (const auto& [name, mesh] : parts) {
    const MeshReport report = inspect(*mesh);
    EXPECT_TRUE(report.closed) << name;
    EXPECT_GT(report.volume, 0) << name;
    EXPECT_EQ(report.degenerate, 0u) << name;
    EXPECT_TRUE(report.uv_in_range) << name;
  }
  for (const Mesh& mesh : {amphora(0.6), bowl(0.2), pedestal(0.4, 1)}) {
    EXPECT_TRUE(inspect(mesh).closed);
    EXPECT_GT(inspect(mesh).volume, 0);
    EXPECT_TRUE(inspect(mesh).normals_face_outward);
  }
}

TEST(Furniture, StandsOnTheFloor) {
  for (const Mesh& mesh :
       {bentwood_chair().wood, potted_plant(1, 5, 1).pot, folding_screen(3, 0.6, 1.8, 20).frame,
        bench(1, 0.4, 0.4).legs, amphora(0.5), bowl(0.1), pedestal(0.3, 1)}) {
    double lowest = 1;
    for (const Vertex& v : mesh.vertices) lowest = std::min(lowest, v.position.z);
    EXPECT_NEAR(lowest, 0, 0.012);  // a leg's end is cut across its direction
  }
}

}  // namespace
}  // namespace kaustik::scenes
