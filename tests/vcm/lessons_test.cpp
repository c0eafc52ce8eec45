// What passes teach goes into bytes and comes back: who goes on from there makes the same pictures
// and traces no pass anew.
#include <cmath>
#include <functional>
#include <random>

#include "kaustik/base/error.h"
#include "kaustik/render/session.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A room with a caustic, so that radii, camera samples and both guides have something to learn.
TestScene caustic_room(int size = 24, const std::string& of_ball = glass()) {
  return TestScene(
      camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, size) +
      flat("rectangle", "", diffuse("0.5, 0.5, 0.5")) +
      flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"), diffuse("0.5, 0.3, 0.2")) +
      flat("rectangle", scale("0.1, 0.1, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.25"),
           diffuse("0, 0, 0") + area_light("40, 36, 32")) +
      sphere("0.2, -0.05, 0.401", 0.4, of_ball));
}

std::unique_ptr<Integrator> made(const TestScene& scene, const std::string& type) {
  return scene.integrator(type, "");
}

SessionSettings passes_from(uint32_t first, uint32_t count) {
  SessionSettings settings;
  settings.seed = 3;
  settings.first_pass = first;
  settings.passes = count;
  settings.samples_per_pass = 4;
  return settings;
}

struct Rendered {
  Image image;
  SessionReport report;
};
Rendered rendered(const TestScene& scene, const Integrator& integrator, uint32_t first,
                  uint32_t count) {
  Session session(scene.scene(), integrator, passes_from(first, count));
  Rendered result;
  result.report = session.run();
  result.image = session.film().image();
  return result;
}

constexpr uint32_t learned = 9, more = 3;

class Learners : public testing::TestWithParam<std::string> {};

TEST_P(Learners, GoOnWithoutTracingAnew) {
  const TestScene scene = caustic_room();
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, learned);
  const Lessons lessons = teacher->lessons();
  ASSERT_FALSE(lessons.empty());

  const auto pupil = made(scene, GetParam());
  pupil->go_on_with(lessons, LessonUse::go_on);
  EXPECT_EQ(pupil->lessons(), lessons);
  const Rendered by_pupil = rendered(scene, *pupil, learned, more);
  const auto alone = made(scene, GetParam());
  const Rendered by_itself = rendered(scene, *alone, learned, more);
  const Rendered by_teacher = rendered(scene, *teacher, learned, more);

  EXPECT_TRUE(same_bits(by_pupil.image, by_teacher.image));
  EXPECT_TRUE(same_bits(by_pupil.image, by_itself.image));
  EXPECT_EQ(pupil->lessons(), teacher->lessons());
  // As many light paths as the passes have, while who starts alone traces all before.
  EXPECT_EQ(by_pupil.report.photons, by_teacher.report.photons);
  EXPECT_GT(by_itself.report.photons, 2 * by_pupil.report.photons);
  EXPECT_LT(by_pupil.report.rays, by_itself.report.rays);
  // Earlier passes are those that they would be.
  const Rendered first = rendered(scene, *made(scene, GetParam()), 0, 1);
  EXPECT_TRUE(same_bits(rendered(scene, *pupil, 0, 1).image, first.image));
}

TEST_P(Learners, OtherSeedsLearnForThemselves) {
  const TestScene scene = caustic_room(16);
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 3);
  const auto pupil = made(scene, GetParam());
  pupil->go_on_with(teacher->lessons(), LessonUse::go_on);
  const auto picture = [&](const Integrator& integrator) {
    SessionSettings settings = passes_from(4, 1);
    settings.seed = 8;
    Session session(scene.scene(), integrator, settings);
    session.run();
    return session.film().image();
  };
  EXPECT_TRUE(same_bits(picture(*pupil), picture(*made(scene, GetParam()))));
}

TEST_P(Learners, HoldForAllPassesWhenTheyAreFixed) {
  const TestScene scene = caustic_room();
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 8);
  const Lessons lessons = teacher->lessons();
  const auto fixed = [&](uint32_t first, uint32_t count) {
    const auto pupil = made(scene, GetParam());
    pupil->go_on_with(lessons, LessonUse::fixed);
    const Rendered result = rendered(scene, *pupil, first, count);
    EXPECT_EQ(pupil->lessons(), lessons) << "it has gone on learning";
    return result;
  };
  // Any machine renders any pass, and traces no other.
  const Rendered late = fixed(40, 1), early = fixed(0, 1);
  EXPECT_LT(double(late.report.photons), 1.5 * double(early.report.photons));
  EXPECT_GT(double(late.report.photons), 0.5 * double(early.report.photons));
}

TEST_P(Learners, FixedOnesMakeTheSamePicture) {
  const TestScene scene = caustic_room(20, diffuse("0.6, 0.6, 0.6"));
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 8);
  const auto pupil = made(scene, GetParam());
  pupil->go_on_with(teacher->lessons(), LessonUse::fixed);
  const Passes passes = render(scene, *pupil, {32, 5});
  const Passes reference = render(scene, "path", "", {64, 6});
  expect_near_means("fixed lessons", Comparison(passes.mean({""}), reference.mean({""})), 0.01);
}

TEST_P(Learners, LearnWithoutAPicture) {
  const TestScene scene = caustic_room(16);
  const auto teacher = made(scene, GetParam()), pupil = made(scene, GetParam());
  rendered(scene, *teacher, 0, 11);
  const PassReport report = pupil->learn({3, 11, 4, {}}, {}, {});
  EXPECT_EQ(pupil->lessons().passes, 11u);
  EXPECT_EQ(pupil->lessons(), teacher->lessons());
  EXPECT_GT(report.photons, 0u);
  // auto says how many light paths it has; whether they are guided depends.
  if (GetParam() == "auto") {
    EXPECT_FALSE(report.decisions.empty());
  }
  // No further than it is asked to, and not anew.
  EXPECT_EQ(pupil->learn({3, 11, 4, {}}, {}, {}).photons, 0u);
  std::stop_source stopped;
  stopped.request_stop();
  pupil->learn({3, 16, 4, {}}, stopped.get_token(), {});
  EXPECT_EQ(pupil->lessons(), teacher->lessons());
}

TEST_P(Learners, DamageIsTold) {
  const TestScene scene = caustic_room(12);
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 3);
  const Lessons lessons = teacher->lessons();
  const auto refused = [&](const TestScene& of, const std::function<void(Lessons&)>& change) {
    Lessons changed = lessons;
    change(changed);
    EXPECT_THROW(made(of, GetParam())->go_on_with(changed, LessonUse::go_on), Error);
  };
  const size_t size = lessons.bytes.size();
  for (size_t part = 0; part < size; part += 1 + size / 61)
    refused(scene, [&](Lessons& l) { l.bytes.resize(part); });
  refused(scene, [](Lessons& l) { l.bytes.push_back(0); });
  refused(scene, [](Lessons& l) { ++l.passes; });
  refused(caustic_room(20), [](Lessons&) {});
}

/// Lessons may come from anybody: what their checks let pass makes a wrong picture at worst.
TEST_P(Learners, WrongNumbersDoNoHarm) {
  const TestScene scene = caustic_room(8);
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 3);
  const Lessons lessons = teacher->lessons();
  std::mt19937 random(7);
  int taken = 0;
  for (int i = 0; i < 200; ++i) {
    Lessons wrong = lessons;
    const int flips = 1 + i % 8;
    for (int k = 0; k < flips; ++k)
      wrong.bytes[random() % wrong.bytes.size()] ^= uint8_t(1u << random() % 8);
    const auto pupil = made(scene, GetParam());
    try {
      pupil->go_on_with(wrong, i % 2 ? LessonUse::fixed : LessonUse::go_on);
    } catch (const Error&) {
      continue;
    }
    ++taken;
    const Image image = rendered(scene, *pupil, 3, 1).image;
    for (int c = 0; c < image.channel_count(); ++c)
      for (const float value : image.channel(c)) ASSERT_TRUE(std::isfinite(value)) << i;
  }
  EXPECT_GT(taken, 20);
}

INSTANTIATE_TEST_SUITE_P(Methods, Learners, testing::Values("ppm", "auto", "vcm"),
                         [](const auto& method) { return method.param; });

TEST(Learning, DoesNothingWhereNothingIsLearned) {
  const TestScene scene = caustic_room(8);
  const auto path = made(scene, "path");
  rendered(scene, *path, 0, 1);
  EXPECT_EQ(path->learn({3, 4, 4, {}}, {}, {}).rays, 0u);
  EXPECT_TRUE(path->lessons().empty());
}

}  // namespace
}  // namespace kaustik
