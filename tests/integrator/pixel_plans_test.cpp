// Plans of blocks of pixels whose probe finds nothing.

#include "kaustik/integrator/pixel_plans.h"

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
    vertex.flux = {1, 1, 1, 0};
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
  int width() const { return plans_.blocks().x; }
  int height() const { return plans_.blocks().y; }
  size_t at(int x, int y) const { return size_t(y * width() + x); }
  bool found(int x, int y) const { return plans_.probes()[at(x, y)].found; }
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

}  // namespace
}  // namespace kaustik
