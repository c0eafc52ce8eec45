// What passes teach goes into bytes and comes back: who goes on from there makes the same pictures
// and traces no pass anew.
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

bool are_same(const Image& a, const Image& b) {
  for (int c = 0; c < a.channel_count(); ++c)
    if (!std::ranges::equal(a.channel(c), b.channel(c))) return false;
  return a.channel_count() == b.channel_count();
}

constexpr uint32_t learned = 9, more = 3;

class Lessons : public testing::TestWithParam<std::string> {};

TEST_P(Lessons, GoOnWithoutTracingAnew) {
  const TestScene scene = caustic_room();
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, learned);
  const std::vector<uint8_t> lessons = teacher->lessons();
  ASSERT_FALSE(lessons.empty());

  const auto pupil = made(scene, GetParam());
  pupil->go_on_with(lessons, LessonUse::go_on);
  EXPECT_EQ(pupil->lessons(), lessons);
  const Rendered by_pupil = rendered(scene, *pupil, learned, more);
  const auto alone = made(scene, GetParam());
  const Rendered by_itself = rendered(scene, *alone, learned, more);
  const Rendered by_teacher = rendered(scene, *teacher, learned, more);

  EXPECT_TRUE(are_same(by_pupil.image, by_teacher.image));
  EXPECT_TRUE(are_same(by_pupil.image, by_itself.image));
  EXPECT_EQ(pupil->lessons(), teacher->lessons());
  // As many light paths as the passes have, while who starts alone traces all before.
  EXPECT_EQ(by_pupil.report.photons, by_teacher.report.photons);
  EXPECT_GT(by_itself.report.photons, 2 * by_pupil.report.photons);
  EXPECT_LT(by_pupil.report.rays, by_itself.report.rays);
  // Earlier passes are those that they would be.
  const Rendered first = rendered(scene, *made(scene, GetParam()), 0, 1);
  EXPECT_TRUE(are_same(rendered(scene, *pupil, 0, 1).image, first.image));
}

TEST_P(Lessons, OtherSeedsLearnForThemselves) {
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
  EXPECT_TRUE(are_same(picture(*pupil), picture(*made(scene, GetParam()))));
}

TEST_P(Lessons, HoldForAllPassesWhenTheyAreFixed) {
  const TestScene scene = caustic_room();
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 8);
  const std::vector<uint8_t> lessons = teacher->lessons();
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

TEST_P(Lessons, FixedOnesMakeTheSamePicture) {
  const TestScene scene = caustic_room(20, diffuse("0.6, 0.6, 0.6"));
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 8);
  const auto pupil = made(scene, GetParam());
  pupil->go_on_with(teacher->lessons(), LessonUse::fixed);
  const Passes passes = render(scene, *pupil, {32, 5});
  const Passes reference = render(scene, "path", "", {64, 6});
  expect_near_means("fixed lessons", Comparison(passes.mean({""}), reference.mean({""})), 0.01);
}

TEST_P(Lessons, DamageIsTold) {
  const TestScene scene = caustic_room(12);
  const auto teacher = made(scene, GetParam());
  rendered(scene, *teacher, 0, 3);
  const std::vector<uint8_t> lessons = teacher->lessons();
  for (size_t size = 0; size < lessons.size(); size += 1 + lessons.size() / 61) {
    const std::vector<uint8_t> part(lessons.begin(), lessons.begin() + std::ptrdiff_t(size));
    EXPECT_THROW(made(scene, GetParam())->go_on_with(part, LessonUse::go_on), Error) << size;
  }
  std::vector<uint8_t> longer = lessons;
  longer.push_back(0);
  EXPECT_THROW(made(scene, GetParam())->go_on_with(longer, LessonUse::go_on), Error);
  const TestScene other = caustic_room(20);
  EXPECT_THROW(made(other, GetParam())->go_on_with(lessons, LessonUse::go_on), Error);
}

INSTANTIATE_TEST_SUITE_P(Methods, Lessons, testing::Values("ppm", "auto", "vcm"),
                         [](const auto& method) { return method.param; });

TEST(LessonsOf, MethodsThatLearnNothing) {
  const TestScene scene = caustic_room(8);
  const auto path = made(scene, "path");
  rendered(scene, *path, 0, 1);
  EXPECT_TRUE(path->lessons().empty());
}

}  // namespace
}  // namespace kaustik
