// When plans change by what passes teach, from which passes is learned, and what a pass adds.

#include "kaustik/base/error.h"
#include "kaustik/vcm/lessons/lesson_kinds.h"
#include "kaustik/vcm/lessons/lessons.h"
#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

class LessonEpochs : public testing::Test {
 protected:
  LessonEpochs() : settings_(Arguments(ppm_info(), {}, {}, problems_)) {
    settings_.guiding = settings_.edges = false;
    plain_ = std::make_shared<const LightPathEmission>(ball_.scene(), settings_.aim);
    first_ = planned();
  }
  FirstPlans planned() const {
    return VcmPlanner(ball_.scene(), settings_, plain_).make(samples, {});
  }
  VcmLessons lessons() const { return {ball_.scene(), settings_, *plain_, first_, seed}; }
  std::vector<std::unique_ptr<Lesson>> kinds() const {
    return make_lessons({.scene = ball_.scene(),
                         .settings = settings_,
                         .plain = *plain_,
                         .first = *first_.plans,
                         .use = first_.use});
  }
  static Pass pass(uint32_t index, uint64_t of_seed = seed, uint32_t of_samples = samples) {
    return {of_seed, index, of_samples, {}};
  }
  /// A pass of these plans, traced.
  std::unique_ptr<VcmPass> traced(const Pass& pass, std::shared_ptr<const VcmPlans> plans,
                                  uint32_t remembered_paths = 0) const {
    auto result = std::make_unique<VcmPass>(ball_.scene(), settings_, std::move(plans), pass);
    SplatBuffer nowhere = SplatBuffer::nowhere();
    PassReport report;
    result->trace_light({.remembered_paths = remembered_paths}, nowhere, {}, {}, report);
    return result;
  }
  /// The plans of a pass of these lessons.
  static std::shared_ptr<const VcmPlans> plans_of(VcmLessons& all, const Pass& pass) {
    PassReport report;
    return all.plans_for(pass, {}, {}, report).plans;
  }
  void teach(VcmLessons& all, const Pass& pass, const std::stop_token& stop = {}) const {
    uint64_t rays = 0;
    all.learn(*traced(pass, first_.plans), stop, rays);
  }

  static constexpr uint64_t seed = 3;
  static constexpr uint32_t samples = 4;
  HollowBall ball_;
  Problems problems_;
  VcmSettings settings_;
  std::shared_ptr<const LightPathEmission> plain_;
  FirstPlans first_;
};

TEST_F(LessonEpochs, BeginAtPowersOfTwo) {
  const VcmLessons all = lessons();
  const std::pair<uint32_t, uint32_t> rows[] = {{0, 0},     {1, 1},     {2, 2},     {3, 2},
                                                {4, 4},     {7, 4},     {8, 8},     {255, 128},
                                                {256, 256}, {300, 256}, {9999, 256}};
  for (const auto& [index, begin] : rows) EXPECT_EQ(all.epoch_begin(index), begin) << index;
  EXPECT_EQ(all.end(), 256u);
}

/// A lesson for each thing that can change.
TEST_F(LessonEpochs, GoByTheSettings) {
  const auto ends = [&] {
    std::vector<uint32_t> result;
    for (const auto& lesson : kinds()) result.push_back(lesson->end());
    return result;
  };
  using Ends = std::vector<uint32_t>;
  EXPECT_EQ(ends(), (Ends{256, 64}));
  settings_.radius = 0.1f;
  EXPECT_EQ(ends(), (Ends{64}));
  settings_.adaptive = false;
  EXPECT_EQ(ends(), Ends());
  settings_.radius = 0;
  EXPECT_EQ(ends(), (Ends{256}));
  settings_.guiding = true;
  EXPECT_EQ(ends(), (Ends{256, 16}));
  settings_.learn_radii = false;
  EXPECT_EQ(ends(), (Ends{16}));
  EXPECT_EQ(lessons().end(), 16u);
}

/// Of a picture with a single sample per pixel none can be shared out.
TEST_F(LessonEpochs, ShareOutNoSingleSample) {
  first_ = VcmPlanner(ball_.scene(), settings_, plain_).make(1, {});
  ASSERT_EQ(kinds().size(), 1u);
  EXPECT_EQ(kinds()[0]->end(), 256u);
}

/// Passes are learned from in their order, and plans that have been made stay.
TEST_F(LessonEpochs, FollowThePasses) {
  VcmLessons all = lessons();
  EXPECT_TRUE(all.serve(pass(0)) && all.serve(pass(1)) && all.serve(pass(2)));
  EXPECT_FALSE(all.serve(pass(0, 4)) || all.serve(pass(0, seed, 8)));
  // Of another seed, of other samples, out of order.
  for (const Pass& other : {pass(0, 4), pass(0, seed, 8), pass(1)}) {
    teach(all, other);
    EXPECT_EQ(all.passes(), 0u);
  }
  teach(all, pass(0));
  EXPECT_EQ(all.passes(), 1u);
  // Nobody has asked for the plans of pass 1: it has none to be learned with.
  teach(all, pass(1));
  EXPECT_EQ(all.passes(), 1u);
  const auto second = plans_of(all, pass(1));
  EXPECT_NE(second, first_.plans);
  EXPECT_EQ(plans_of(all, pass(1)), second);
  teach(all, pass(1));
  EXPECT_EQ(all.passes(), 2u);
  EXPECT_EQ(plans_of(all, pass(1)), second);
  EXPECT_EQ(plans_of(all, pass(0)), first_.plans);
  // Those that are missing are traced.
  EXPECT_NE(plans_of(all, pass(5)), second);
  EXPECT_EQ(all.passes(), 4u);
  all.begin(8);
  EXPECT_EQ(all.passes(), 0u);
  EXPECT_TRUE(all.serve(pass(0, 8)) && !all.serve(pass(0)));
  EXPECT_EQ(plans_of(all, pass(0, 8)), first_.plans);
}

/// What was learned and written knows the plans of its last epoch alone.
TEST_F(LessonEpochs, OnlyTheLastIsWritten) {
  VcmLessons all = lessons();
  PassReport report;
  EXPECT_EQ(all.make_up(pass(3), 3, {}, {}, report), 3u);
  ByteWriter writer;
  all.write(writer);
  ByteReader reader(writer.bytes(), "lessons");
  const auto read = VcmLessons::read(reader, ball_.scene(), settings_, *plain_);
  EXPECT_EQ(read->passes(), 3u);
  EXPECT_TRUE(read->serve(pass(2)) && read->serve(pass(3)) && read->serve(pass(4)));
  EXPECT_FALSE(read->serve(pass(0)) || read->serve(pass(1)));
}

TEST_F(LessonEpochs, StoppedOnesTeachNothing) {
  VcmLessons all = lessons();
  std::stop_source stop;
  stop.request_stop();
  teach(all, pass(0), stop.get_token());
  EXPECT_EQ(all.passes(), 0u);
  teach(all, pass(0));
  EXPECT_EQ(all.passes(), 1u);
  PassReport report;
  EXPECT_EQ(all.plans_for(pass(1), stop.get_token(), {}, report).plans, first_.plans);
  EXPECT_NE(plans_of(all, pass(1)), first_.plans);
}

/// Guides are learned from the last pass of each of the first epochs.
TEST_F(LessonEpochs, GuidesRememberPathsOfTheLastPassOfAnEpoch) {
  settings_.guiding = true;
  first_ = planned();
  const auto lesson = make_guide_lesson({.scene = ball_.scene(),
                                         .settings = settings_,
                                         .plain = *plain_,
                                         .first = *first_.plans,
                                         .use = first_.use});
  ASSERT_TRUE(lesson);
  EXPECT_EQ(lesson->end(), 16u);
  for (uint32_t pass = 0; pass < 16; ++pass) {
    const bool is_last = pass == 0 || pass == 1 || pass == 3 || pass == 7 || pass == 15;
    EXPECT_EQ(lesson->needs_of(pass).any(), is_last);
    EXPECT_EQ(lesson->needs_of(pass).remembered_paths, is_last ? LightPathUse::most_paths : 0u);
  }
  VcmLessons all = lessons();
  PassReport report;
  EXPECT_EQ(all.plans_for(pass(0), {}, {}, report).remembered_paths, LightPathUse::most_paths);
  EXPECT_EQ(all.plans_for(pass(2), {}, {}, report).remembered_paths, 0u);
  EXPECT_EQ(all.plans_for(pass(31), {}, {}, report).remembered_paths, 0u);
}

/// What passes add may be found out elsewhere, and come as bytes: it teaches the same.
TEST_F(LessonEpochs, SumsComeBack) {
  settings_.guiding = true;
  first_ = planned();
  const auto here = kinds(), there = kinds();
  ASSERT_EQ(here.size(), 3u);
  for (uint32_t index = 0; index < 4; ++index) {
    const auto taught = traced(pass(index), first_.plans, LightPathUse::most_paths);
    const BlockGrid& grid = first_.plans->pixels.seen().grid();
    const TakeSample take = [&](const Vec2f& raster, Sampler& sampler, SampleSink& sink) {
      taught->sample(grid.window().in_crop(raster), sampler, sink);
    };
    for (size_t i = 0; i < here.size(); ++i) {
      if (!here[i]->needs_of(index).any()) continue;
      const auto places = here[i]->places(taught->pass());
      const auto pairs = training_pairs({.grid = grid,
                                         .filter = ball_.scene().film().filter,
                                         .components = settings_.components,
                                         .pass = taught->pass(),
                                         .take = take},
                                        places, {});
      const auto sums =
          here[i]->sums_of({.light = {&taught->light()}, .places = places, .pairs = pairs}, {});
      ByteWriter writer;
      sums->write(writer);
      ByteReader reader(writer.bytes(), "sums");
      const auto read = there[i]->read_sums(reader);
      EXPECT_NO_THROW(reader.expect_end());
      here[i]->add(index, *sums);
      there[i]->add(index, *read);
      // Half of them is told.
      const std::span<const uint8_t> half(writer.bytes().data(), writer.bytes().size() / 2);
      ByteReader cut(half, "sums");
      EXPECT_THROW(there[i]->read_sums(cut), Error);
    }
  }
  for (size_t i = 0; i < here.size(); ++i) {
    ByteWriter by_sums, by_bytes, nothing;
    here[i]->write(by_sums);
    there[i]->write(by_bytes);
    kinds()[i]->write(nothing);
    EXPECT_EQ(by_sums.bytes(), by_bytes.bytes()) << i;
    EXPECT_NE(by_sums.bytes(), nothing.bytes()) << i;
  }
}

/// What lessons have changed is told once, beside what the planner told.
TEST_F(LessonEpochs, TellWhatTheyDecide) {
  VcmLessons all = lessons();
  EXPECT_EQ(plans_of(all, pass(0))->decisions, first_.plans->decisions);
  for (const uint32_t index : {1u, 4u}) {
    const auto plans = plans_of(all, pass(index));
    size_t of_disks = 0;
    for (const std::string& decision : plans->decisions)
      of_disks += decision.find("disks of merging") != std::string::npos;
    EXPECT_EQ(of_disks, 1u) << index;
  }
  settings_.learn_radii = settings_.adaptive = false;
  VcmLessons none = lessons();
  EXPECT_EQ(plans_of(none, pass(4))->decisions, first_.plans->decisions);
}

}  // namespace
}  // namespace kaustik
