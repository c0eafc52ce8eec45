// When plans change by what passes teach, and from which passes is learned.

#include "kaustik/vcm/lessons/guide_lesson.h"
#include "kaustik/vcm/lessons/lessons.h"
#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

void take_nothing(const Vec2f&, Sampler&, SampleSink&) {}

class LessonEpochs : public testing::Test {
 protected:
  LessonEpochs() : settings_(Arguments(ppm_info(), {}, {}, problems_)) {
    settings_.guiding = settings_.edges = false;
    plain_ = std::make_shared<const LightPathEmission>(ball_.scene(), settings_.aim);
    first_ =
        std::make_shared<const VcmPlans>(VcmPlanner(ball_.scene(), settings_, plain_).make(4, {}));
  }
  VcmLessons lessons() const { return {ball_.scene(), first_, settings_, 3}; }
  static Pass pass(uint32_t index, uint64_t seed = 3, uint32_t samples = 4) {
    return {seed, index, samples};
  }

  HollowBall ball_;
  Problems problems_;
  VcmSettings settings_;
  std::shared_ptr<const LightPathEmission> plain_;
  std::shared_ptr<const VcmPlans> first_;
};

TEST_F(LessonEpochs, BeginAtPowersOfTwo) {
  const VcmLessons all = lessons();
  const std::pair<uint32_t, uint32_t> rows[] = {{0, 0},     {1, 1},     {2, 2},     {3, 2},
                                                {4, 4},     {7, 4},     {8, 8},     {255, 128},
                                                {256, 256}, {300, 256}, {9999, 256}};
  for (const auto& [index, begin] : rows) EXPECT_EQ(all.epoch_begin(index), begin) << index;
  EXPECT_EQ(all.end(), 256u);
  EXPECT_TRUE(all.wants(255) && !all.wants(256));
  EXPECT_TRUE(all.wants_samples(63) && !all.wants_samples(64));
}

/// A lesson for each thing that can change.
TEST_F(LessonEpochs, GoByTheSettings) {
  settings_.radius = 0.1f;
  EXPECT_EQ(lessons().end(), 64u);
  settings_.adaptive = false;
  EXPECT_EQ(lessons().end(), 0u);
  settings_.radius = 0;
  EXPECT_EQ(lessons().end(), 256u);
  EXPECT_FALSE(lessons().wants_samples(0));
  settings_.learn_radii = false;
  EXPECT_EQ(lessons().end(), 0u);
}

/// Passes are learned from in their order, and plans that have been made stay.
TEST_F(LessonEpochs, FollowThePasses) {
  VcmLessons all = lessons();
  uint64_t rays = 0;
  EXPECT_TRUE(all.expects(pass(0)));
  EXPECT_FALSE(all.expects(pass(1)));
  EXPECT_FALSE(all.expects(pass(0, 4)));
  EXPECT_FALSE(all.expects(pass(0, 3, 8)));
  EXPECT_TRUE(all.knows_epoch(0) && all.knows_epoch(1) && all.knows_epoch(2));
  const LightVertices light = ball_.trace(merging_weights(500, 0.1f), 500, 0, 100);
  const auto teach = [&](uint32_t index) {
    all.learn({.pass = pass(index), .light = light, .sample = take_nothing}, {}, rays);
  };
  teach(0);
  EXPECT_EQ(all.passes(), 1u);
  // Nobody has asked for the plans of pass 1: it has none to be learned with.
  EXPECT_FALSE(all.expects(pass(1)));
  const auto second = all.plans_of(1, {}, rays);
  EXPECT_NE(second, first_);
  EXPECT_TRUE(all.expects(pass(1)));
  EXPECT_EQ(all.plans_of(1, {}, rays), second);
  teach(1);
  EXPECT_TRUE(all.knows_epoch(1) && all.knows_epoch(2));
  // The sums of pass 1 alone are no longer there; its plans are.
  teach(2);
  EXPECT_FALSE(all.knows_epoch(2));
  all.begin(8);
  EXPECT_EQ(all.seed(), 8u);
  EXPECT_EQ(all.passes(), 0u);
  EXPECT_TRUE(all.expects(pass(0, 8)));
  EXPECT_EQ(all.plans_of(0, {}, rays), first_);
}

TEST_F(LessonEpochs, StoppedOnesTeachNothing) {
  VcmLessons all = lessons();
  uint64_t rays = 0;
  std::stop_source stop;
  stop.request_stop();
  all.learn({.pass = pass(0), .light = {}, .sample = take_nothing}, stop.get_token(), rays);
  EXPECT_EQ(all.passes(), 0u);
  all.learn({.pass = pass(0), .light = {}, .sample = take_nothing}, {}, rays);
  EXPECT_EQ(all.plans_of(1, stop.get_token(), rays), first_);
  EXPECT_NE(all.plans_of(1, {}, rays), first_);
}

/// Guides are learned from the last pass of each of the first epochs.
TEST(GuideLesson, RemembersPathsOfTheLastPassOfAnEpoch) {
  VcmPlans plans;
  EXPECT_EQ(GuideLesson::remembered_paths(0, plans), 0u);  // nothing is guided
  const HollowBall ball;
  const auto pilot =
      std::make_shared<LightPathUse>(ball.scene(), ball.emission(), ComponentSet::all());
  plans.use = pilot;
  const GuideLesson lesson(*pilot);
  EXPECT_EQ(lesson.end(), 16u);
  for (uint32_t pass = 0; pass < 40; ++pass) {
    const bool is_last = pass == 0 || pass == 1 || pass == 3 || pass == 7 || pass == 15;
    EXPECT_EQ(GuideLesson::remembered_paths(pass, plans), is_last ? LightPathUse::most_paths : 0u);
    EXPECT_EQ(lesson.wants(pass), is_last);
  }
}

}  // namespace
}  // namespace kaustik
