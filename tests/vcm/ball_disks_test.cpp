// Disks of merging in even light: how wide they are is known on paper.

#include "kaustik/vcm/plan/pixel_plans.h"

#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

/// Disks of a ball's even light.
class BallDisks : public testing::Test {
 protected:
  static constexpr int wanted = 30;
  /// Of a pilot with that share of the `paths` of a pass.
  PixelPlans disks(uint32_t paths, double share, uint32_t number, float given = 0) const {
    const LightVertices light =
        ball_.trace(merging_weights(paths, 0.1f), uint32_t(share * double(paths)), number, 1 << 20);
    PixelPlans plans(ball_.scene());
    plans.choose_disks(light, paths, wanted, given);
    return plans;
  }
  /// Light vertices of a pass in the disks, by their areas, on average.
  static double in_disks(const PixelPlans& plans, uint32_t paths) {
    double sum = 0;
    for (const PixelPlan& plan : plans.plans())
      sum += double(plan.merge_area) / double(plans.plans().size());
    return sum * double(paths) * HollowBall::density() * HollowBall::mergeable(100);
  }
  /// Pixels are small beside the disks of HoldWhatIsWanted.
  HollowBall ball_{30};
};

/// As many vertices of a pass as are wanted lie in the disks, of however few paths a pilot tells.
TEST_F(BallDisks, HoldWhatIsWanted) {
  constexpr uint32_t paths = 3000;
  for (const double share : {1.0, 0.5}) {
    RunningStatistics found;
    for (uint32_t number = 0; number < (slow_build ? 6 : 96); ++number)
      found.add(in_disks(disks(paths, share, number), paths));
    expect_known_mean("vertices in a disk", found, wanted, 0.06);
  }
}

/// Between one and six widths of a pixel, or as wide as is asked for.
TEST_F(BallDisks, HaveBounds) {
  const PixelPlans few = disks(300, 1, 0), many = disks(200'000, 1, 0),
                   given = disks(300, 1, 0, 0.2f);
  const std::vector<PixelProbe>& probes = few.seen().probes();
  for (size_t i = 0; i < probes.size(); ++i) {
    const float pixel = pi * sqr(probes[i].pixel_width);
    EXPECT_NEAR(few.plans()[i].merge_area, 36 * pixel, 1e-4f * pixel);
    EXPECT_NEAR(many.plans()[i].merge_area, pixel, 1e-4f * pixel);
    EXPECT_EQ(given.plans()[i].merge_area, pi * sqr(0.2f));
    EXPECT_EQ(given.plans()[i].survival, 1);
  }
  EXPECT_EQ(given.other_area(), pi * sqr(0.2f));
  // Elsewhere as many vertices as are wanted, one of them in the middle; 3 % of the distance at
  // most.
  EXPECT_NEAR(few.other_area(), pi * sqr(0.03f * few.seen().mean_distance()), 1e-6f);
  const double expected =
      (wanted - 1) / (200'000 * HollowBall::density() * HollowBall::mergeable(100));
  EXPECT_NEAR(double(many.other_area()) / expected, 1, 0.05);
}

TEST_F(BallDisks, ShrinkWithThePasses) {
  PixelPlans plans = disks(3000, 1, 0);
  std::vector<PixelPlan> other = plans.plans();
  other[7] = {.merge_area = 0.5f, .survival = 0.25f, .glossy_survival = 0.75f, .evenness = 2};
  plans = plans.with(other);
  const Vec2f at = plans.seen().probes()[7].raster;
  const PixelPlan plan = plans.at(at, 0.1f);
  EXPECT_FLOAT_EQ(plan.merge_area, 0.05f);
  EXPECT_EQ(plan.survival, 0.25f);
  EXPECT_EQ(plan.evenness, 2);
  EXPECT_FLOAT_EQ(plan.counted_area(4), 0.0125f);
  EXPECT_FLOAT_EQ(plan.counted_survival(0), 0.5f);
  EXPECT_FLOAT_EQ(plan.counted_survival(1), 0.75f);
  EXPECT_FLOAT_EQ(plan.counted_survival(0.5f), 0.625f);
  EXPECT_FLOAT_EQ(plan.survival_toward(0.5f), 0.5f);
}

/// Where no light has come nothing merges.
TEST_F(BallDisks, OfNoLightAreNone) {
  PixelPlans plans(ball_.scene());
  plans.choose_disks(LightVertices(), 1000, wanted, 0);
  for (const PixelPlan& plan : plans.plans()) EXPECT_EQ(plan.merge_area, 0);
}

}  // namespace
}  // namespace kaustik
