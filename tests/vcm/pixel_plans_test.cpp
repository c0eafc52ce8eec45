// Plans of blocks of pixels whose probe finds nothing.

#include "kaustik/vcm/plan/pixel_plans.h"

#include <random>

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Eight by eight blocks of sky, before it a far plate on the left and, over one more row on
/// either side, a near one on the right: the rows at the top and at the bottom show nothing else.
TestScene plates() {
  const std::string grey = diffuse("0.5, 0.5, 0.5");
  return TestScene(camera("0, 0, 0", "0, 0, -1", 90, 32, "0, 1, 0") + constant_light(1) +
                   flat("rectangle", translate("-1.9, 0, -4"), grey) +
                   flat("rectangle", scale("0.12, 0.48, 1") + translate("0.6, 0, -1"), grey));
}

/// As many vertices of light paths on both plates as a pass has.
LightVertices light_on_plates() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Vec3f> positions;
  std::vector<LightVertexData> data;
  for (int i = 0; i < 4000; ++i) {
    LightVertexData vertex;
    vertex.flux = Spectrum(1, 1, 1, 0);
    vertex.direction = PackedDirection({0, 0, 1});
    vertex.side = CoarseNormal({0, 0, 1});
    data.push_back(vertex);
    const Vec2f u(unit(random), unit(random));
    positions.push_back(i % 2 == 0 ? Vec3f(-1.9f + u.x, u.y, -4)
                                   : Vec3f(0.6f + 0.12f * u.x, 0.48f * u.y, -1));
  }
  LightVertices light;
  light.tree = {std::move(positions), std::move(data)};
  light.path_count = 4000;
  return light;
}

class PixelPlanGaps : public testing::Test {
 protected:
  PixelPlanGaps() : plans_(scene_.scene()) {
    for (int y = 0; y < height(); ++y) {
      std::string row;
      for (int x = 0; x < width(); ++x) row += found(x, y) ? '#' : '.';
      rows_.push_back(row);
    }
  }
  int width() const { return plans_.seen().grid().count().x; }
  int height() const { return plans_.seen().grid().count().y; }
  size_t at(int x, int y) const { return size_t(y * width() + x); }
  bool found(int x, int y) const { return plans_.seen().probes()[at(x, y)].found; }
  bool is_known(int y) const { return rows_[size_t(y)].find('#') != std::string::npos; }
  /// The row nearest to y of which something is known.
  int known_row(int y) const {
    for (int away = 0;; ++away)
      for (const int row : {y - away, y + away})
        if (row >= 0 && row < height() && is_known(row)) return row;
  }

  TestScene scene_ = plates();
  PixelPlans plans_;
  std::vector<std::string> rows_;
};

TEST_F(PixelPlanGaps, AreWhereTheProbesMeetTheSky) {
  EXPECT_EQ(rows_, (std::vector<std::string>{"........", "........", "......#.", ".##...#.",
                                             ".##...#.", "......#.", "........", "........"}));
}

/// Of plans that all differ, those of a found block of the same row take the place, else of the
/// nearest row that has one, as a whole.
TEST_F(PixelPlanGaps, TakeWholePlansOfTheirRow) {
  std::vector<PixelPlan> own(plans_.plans().size());
  for (size_t i = 0; i < own.size(); ++i)
    own[i] = {float(i + 1), float(i + 1) / float(own.size()), 1 + float(i)};
  const std::vector<PixelPlan> filled = plans_.with(own).plans();
  for (int y = 0; y < height(); ++y)
    for (int x = 0; x < width(); ++x) {
      SCOPED_TRACE(fmt::format("block {}, {}", x, y));
      const PixelPlan& plan = filled[at(x, y)];
      const auto source = size_t(plan.merge_area) - 1;
      const int from_x = int(source) % width(), from_y = int(source) / width();
      EXPECT_TRUE(found(from_x, from_y));
      EXPECT_EQ(from_y, known_row(y));
      EXPECT_TRUE(!found(x, y) || source == at(x, y));
      EXPECT_EQ(plan.survival, own[source].survival);
      EXPECT_EQ(plan.evenness, own[source].evenness);
    }
}

/// Also the disks that choose_disks() makes, which are small on the near plate.
TEST_F(PixelPlanGaps, TakeDisksOfTheirRow) {
  plans_.choose_disks(light_on_plates(), 4000, 30, 0);
  const auto area = [&](int x, int y) { return plans_.plans()[at(x, y)].merge_area; };
  for (int y = 0; y < height(); ++y)
    for (int x = 0; x < width(); ++x) {
      SCOPED_TRACE(fmt::format("block {}, {}", x, y));
      std::vector<float> of_row;
      const int row = known_row(y);
      for (int i = 0; i < width(); ++i)
        if (found(i, row)) of_row.push_back(area(i, row));
      EXPECT_GT(area(x, y), 0);
      EXPECT_NE(std::find(of_row.begin(), of_row.end(), area(x, y)), of_row.end());
    }
  EXPECT_GT(area(1, 3), 2 * area(6, 3));
}

/// A floor that a wall ends at x = 0.5, and a shelf 1 m over its left part, seen from above: 8 × 8
/// blocks of 0.25 m on the floor. The shelf's end, at x = −0.45, is seen at x = −0.5.
class PlanDiskBounds : public testing::Test {
 protected:
  static constexpr float block = 0.25f, pixel = block / 4;
  PlanDiskBounds() : plans_(scene_.scene()) {
    uint64_t rays = 0;
    plans_.find_edges(scene_.scene(), widths, 0, rays);
    EXPECT_GT(rays, 0u);
  }
  /// Where a point of the floor is seen.
  static Vec2f raster(float x, float y) { return Vec2f(16 + x / pixel, 16 - y / pixel); }
  SurfaceVertex vertex(const Vec3f& from, const Vec3f& direction) const {
    const Ray ray{from, direction, infinity};
    Hit hit;
    EXPECT_TRUE(scene_.scene().intersect(ray, hit));
    SurfaceVertex result;
    result.meet(scene_.scene(), ray, hit, TransportMode::radiance);
    return result;
  }
  SurfaceVertex on_floor(float x, float y) const { return vertex({x, y, 0.5f}, {0, 0, -1}); }
  SurfaceVertex on_shelf(float x, float y) const { return vertex({x, y, 5}, {0, 0, -1}); }
  static void expect_edge(const DiskBounds& found, float distance) {
    ASSERT_EQ(found.edges.count, 1u);
    EXPECT_NEAR(found.edges.edges[0].inward.x, -1, 1e-3);
    EXPECT_NEAR(found.edges.edges[0].distance, distance, 2e-3);
  }
  static void expect_nothing_known(const DiskBounds& found) {
    EXPECT_EQ(found.edges.count, 0u);
    EXPECT_FALSE(found.are_complete);
  }

  static constexpr float widths = 4;  ///< radii up to a block; sought as far as two
  const std::string grey_ = diffuse("0.5, 0.5, 0.5");
  TestScene scene_{
      camera("0, 0, 10", "0, 0, 0", 2 * std::atan(0.1) * 180 / std::numbers::pi, 32, "0, 1, 0") +
      flat("rectangle", scale("3, 3, 1"), grey_) +
      flat("rectangle", scale("0.1, 3, 1") + rotate("0, 1, 0", -90) + translate("0.5, 0, 0.1"),
           grey_) +
      flat("rectangle", scale("1, 3, 1") + translate("-1.45, 0, 1"), grey_)};
  PixelPlans plans_;
};

TEST_F(PlanDiskBounds, EdgesThatCutTheDisk) {
  const SurfaceVertex vertex = on_floor(0.3f, 0.1f);
  const auto wide = plans_.seen().disk_bounds(raster(0.3f, 0.1f), vertex, 0.24f);
  expect_edge(wide, 0.2f);
  EXPECT_TRUE(wide.are_complete);
  const auto narrow = plans_.seen().disk_bounds(raster(0.3f, 0.1f), vertex, 0.19f);
  EXPECT_EQ(narrow.edges.count, 0u);
  EXPECT_TRUE(narrow.are_complete);
  // The same around a probe, the middle of its block.
  const size_t probe = 3 * 8 + 5;
  EXPECT_NEAR(plans_.seen().probes()[probe].vertex.position().x, 0.375, 1e-3);
  expect_edge(plans_.seen().disk_bounds(probe, 0.24f), 0.125f);
}

/// Beyond two blocks from the probe nobody has looked.
TEST_F(PlanDiskBounds, AreCompleteWithinWhatWasSeen) {
  const Vec2f at = raster(0.125f, 0.125f);
  const SurfaceVertex middle = on_floor(0.125f, 0.125f), corner = on_floor(0.02f, 0.02f);
  const float reach = 2 * block, off = std::sqrt(2.0f) * 0.105f;
  EXPECT_TRUE(plans_.seen().disk_bounds(at, middle, 0.97f * reach).are_complete);
  EXPECT_FALSE(plans_.seen().disk_bounds(at, middle, 1.03f * reach).are_complete);
  EXPECT_TRUE(plans_.seen().disk_bounds(at, corner, 0.97f * reach - off).are_complete);
  EXPECT_FALSE(plans_.seen().disk_bounds(at, corner, 1.03f * reach - off).are_complete);
  EXPECT_FALSE(SeenSurfaces(scene_.scene()).disk_bounds(at, middle, 0.01f).are_complete);
}

/// Neither of another plane nor of the other side of the plane.
TEST_F(PlanDiskBounds, OfTheRightPlaneAndSide) {
  const Vec2f at = raster(0.3f, 0.1f);
  expect_nothing_known(plans_.seen().disk_bounds(at, on_shelf(-0.7f, 0.1f), 0.2f));
  expect_nothing_known(plans_.seen().disk_bounds(at, vertex({0.3f, 0.1f, -1}, {0, 0, 1}), 0.24f));
  expect_nothing_known(
      plans_.seen().disk_bounds(at, vertex({0.3f, 0.1f, 0.1f}, {1, 0, 0}), 0.2f));  // on the wall
  // What lies behind the wall is told by a block beside, whose probe lies there too.
  const auto behind = plans_.seen().disk_bounds(at, on_floor(0.6f, 0.1f), 0.2f);
  ASSERT_EQ(behind.edges.count, 1u);
  EXPECT_NEAR(behind.edges.edges[0].inward.x, 1, 1e-3);
  EXPECT_NEAR(behind.edges.edges[0].distance, 0.1, 2e-3);
  expect_nothing_known(plans_.seen().disk_bounds(raster(0.1f, 0.1f), on_floor(0.6f, 0.1f), 0.2f));
}

/// What a block shows but its probe does not may be known of one beside it, not of one farther off.
TEST_F(PlanDiskBounds, OfBlocksBeside) {
  // Seen through a block whose probe is on the shelf, at the shelf's end.
  const Vec2f beside = raster(-0.51f, 0.1f), farther = raster(-0.76f, 0.1f);
  const auto of_shelf = plans_.seen().disk_bounds(beside, on_shelf(-0.5f, 0.1f), 0.2f);
  expect_edge(of_shelf, 0.05f);
  const SurfaceVertex floor = on_floor(-0.3f, 0.1f);
  EXPECT_TRUE(plans_.seen().disk_bounds(beside, floor, 0.1f).are_complete);
  expect_nothing_known(plans_.seen().disk_bounds(farther, floor, 0.1f));
}

}  // namespace
}  // namespace kaustik
