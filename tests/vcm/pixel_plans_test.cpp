// Plans of blocks of pixels whose probe finds nothing.

#include "kaustik/vcm/plan/pixel_plans.h"

#include <array>
#include <numbers>
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

/// Noise of every pixel's own counts once; what a picture shares counts three times as much as that
/// of which filters of 9 and 81 pixels leave a ninth and an 81st.
TEST(NoiseInCommon, CountsWhatFiltersLeave) {
  EXPECT_NEAR(noise_in_common(0), 1, 1e-6);
  EXPECT_NEAR(noise_in_common(1e9f), 3 / (1 + 1 / 9.0 + 1 / 81.0), 1e-4);
  EXPECT_LT(noise_in_common(spread_of_disk(1)), noise_in_common(spread_of_disk(6)));
}

/// What is left of it by filters of 1, 3 and 9 pixels, where disks of `radius` pixels take the mean
/// of random points by the weights of the kernel, over what is left of white noise.
double measured_in_common(double radius) {
  constexpr int side = 54, pictures = 40, density = 2;
  const double reach = std::ceil(radius);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-reach, side + reach);
  std::array<double, 3> left{};
  for (int picture = 0; picture < pictures; ++picture) {
    std::vector<double> value(side * side);
    const auto points = int(density * sqr(side + 2 * reach));
    for (int i = 0; i < points; ++i) {
      const double px = place(random), py = place(random);
      for (int y = std::max(0, int(py - reach)); y < std::min(side, int(py + reach + 1)); ++y)
        for (int x = std::max(0, int(px - reach)); x < std::min(side, int(px + reach + 1)); ++x)
          value[size_t(y * side + x)] +=
              std::max(0.0, 1 - (sqr(x + 0.5 - px) + sqr(y + 0.5 - py)) / sqr(radius));
    }
    const double mean = density * std::numbers::pi * sqr(radius) / 2;
    for (size_t k = 0; k < 3; ++k) {
      const int box = std::array{1, 3, 9}[k], count = side / box;
      for (int by = 0; by < count; ++by)
        for (int bx = 0; bx < count; ++bx) {
          double sum = 0;
          for (int y = 0; y < box; ++y)
            for (int x = 0; x < box; ++x)
              sum += value[size_t((by * box + y) * side + bx * box + x)] - mean;
          left[k] += sqr(sum / sqr(box)) / sqr(count) / pictures;
        }
    }
  }
  return (left[0] + left[1] + left[2]) / left[0] / (1 + 1 / 9.0 + 1 / 81.0);
}

TEST(NoiseInCommon, OfDisksIsThatOfPictures) {
  for (const double radius : {1.0, 2.5, 6.0, 12.0})
    EXPECT_NEAR(noise_in_common(spread_of_disk(float(radius))) / measured_in_common(radius), 1,
                0.12)
        << radius;
}

/// What all samples share, and what is not covered, counts for less in the weights of merging.
TEST(PixelPlan, CountsAreaByCoverageAndWhatIsShared) {
  const PixelPlan plan{.merge_area = 3, .covered = 0.5f, .merging_in_common = 2};
  EXPECT_FLOAT_EQ(plan.counted_area(4), 3 * 0.5f / (4 * 2));
}

PixelPlan plan_of(const PixelPlans& plans, const Vec2f& raster, float shrinkage,
                  const SurfaceVertex& vertex) {
  const Vec3f& ng = vertex.point().ng;
  return plans.at(raster, shrinkage, vertex.position(), vertex.on_front() ? ng : -ng);
}

/// A wall ahead, half of it hidden by a plate that stands a little before it, with an edge of its
/// own that no probe shows.
class PlansOfSurfaces : public testing::Test {
 protected:
  PlansOfSurfaces() : plans_(scene_.scene()) {
    std::vector<PixelPlan> of_surfaces;
    for (const PixelProbe& probe : plans_.seen().probes())
      of_surfaces.push_back({.merge_area = probe.vertex.position().z > -1.95f ? 1.0f : 2.0f,
                             .survival = 0.02f,
                             .evenness = 3});
    plans_ = plans_.with(of_surfaces);
  }
  /// What a ray at that place of the raster meets.
  SurfaceVertex seen_at(const Vec2f& raster) const {
    const Ray ray = scene_.scene().camera().sample_ray(raster, Camera::middle_of_lens());
    Hit hit;
    EXPECT_TRUE(scene_.scene().intersect(ray, hit));
    return {scene_.scene(), ray, hit, TransportMode::radiance};
  }

  TestScene scene_{
      camera("0, 0, 0", "0, 0, -1", 90, 32, "0, 1, 0") + constant_light(1) +
      flat("rectangle", scale("9, 9, 1") + translate("0, 0, -2"), diffuse("0.5, 0.5, 0.5")) +
      flat("rectangle", scale("1, 9, 1") + translate("-1.1, 0, -1.9"), diffuse("0.5, 0.5, 0.5"))};
  PixelPlans plans_;
};

/// The plate ends at pixel 15.2, in a block whose probe shows the wall or the plate: either side
/// has the plan of its own.
TEST_F(PlansOfSurfaces, GoByTheProbeThatShowsTheSurface) {
  for (const float x : {13.0f, 14.5f, 15.0f, 15.5f, 16.5f, 18.0f}) {
    const Vec2f raster(x, 14.5f);
    const SurfaceVertex vertex = seen_at(raster);
    const bool is_plate = vertex.position().z > -1.95f;
    EXPECT_EQ(is_plate, x < 15.2f);
    EXPECT_EQ(plan_of(plans_, raster, 1, vertex).merge_area, is_plate ? 1 : 2) << x;
    EXPECT_EQ(plan_of(plans_, raster, 0.5f, vertex).merge_area, is_plate ? 0.5f : 1) << x;
    EXPECT_EQ(plan_of(plans_, raster, 1, vertex).survival, 0.02f);
  }
}

/// Where a surface stands across all that the probes around show, disks are hardly wider than a
/// pixel, and more paths go on.
TEST_F(PlansOfSurfaces, AreCarefulOfWhatNoProbeShows) {
  const TestScene bevel(camera("0, 0, 0", "0, 0, -1", 90, 32, "0, 1, 0") + constant_light(1) +
                        flat("rectangle",
                             scale("9, 9, 1") + rotate("0, 1, 0", 60) + translate("0, 0, -2"),
                             diffuse("0.5, 0.5, 0.5")));
  const Vec2f raster(17, 17);
  const Ray ray = bevel.scene().camera().sample_ray(raster, Camera::middle_of_lens());
  Hit hit;
  ASSERT_TRUE(bevel.scene().intersect(ray, hit));
  const SurfaceVertex vertex(bevel.scene(), ray, hit, TransportMode::radiance);
  const PixelPlan plan = plan_of(plans_, raster, 1, vertex);
  const float width = plans_.seen().probes()[plans_.seen().grid().index_at(raster)].pixel_width;
  EXPECT_FLOAT_EQ(plan.merge_radius(), 1.5f * width);
  EXPECT_GT(plan.survival, 0.3f);
  EXPECT_EQ(plan.evenness, 1);
  EXPECT_LT(plan.merging_in_common, 2);
  // Nor is the back of a surface what its front shows: light paths may come from there.
  const SurfaceVertex wall = seen_at(raster);
  const Vec3f& ng = wall.point().ng;
  const Vec3f front = wall.on_front() ? ng : -ng;
  EXPECT_EQ(plans_.at(raster, 1, wall.position(), front).merge_area, 2);
  EXPECT_FLOAT_EQ(plans_.at(raster, 1, wall.position(), -front).merge_radius(), 1.5f * width);
  // A radius that was asked for is a radius everywhere.
  PixelPlans given = plans_;
  given.choose_disks({}, 1, 30, 0.25f);
  EXPECT_FLOAT_EQ(plan_of(given, raster, 1, vertex).merge_radius(), 0.25f);
}

}  // namespace
}  // namespace kaustik
