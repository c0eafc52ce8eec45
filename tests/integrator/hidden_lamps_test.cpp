// Lamps that the camera does not see itself: it looks through them, and their light stays.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

const std::string hidden = set("visible", false);
std::string square_lamp(const std::string& more) {
  return R"(<emitter type="area"><rgb name="radiance" value="4"/>)" + set("two_sided", true) +
         more + "</emitter>";
}
/// Between the camera and a wall, large enough to fill the picture.
std::string lamp_before_wall(const std::string& more) {
  return camera("0, 0, 4", "0, 0, 0", 40, 8, "0, 1, 0") +
         flat("rectangle", scale("4, 4, 1"), diffuse("0.5")) +
         flat("rectangle", scale("1.2, 1.2, 1") + translate("0, 0, 1"),
              diffuse("0.3") + square_lamp(more));
}
/// The wall alone, with the light that the lamp gives it: where the camera stands before the lamp.
std::string wall_before_lamp() {
  return camera("0, 0, 0.9", "0, 0, 0", 20, 8, "0, 1, 0") +
         flat("rectangle", scale("4, 4, 1"), diffuse("0.5")) +
         flat("rectangle", scale("1.2, 1.2, 1") + translate("0, 0, 1"),
              diffuse("0.3") + square_lamp(""));
}

TEST(HiddenLamps, AreLookedThroughByEveryMethod) {
  const TestScene scene(lamp_before_wall(hidden)), seen(lamp_before_wall(""));
  const RunningStatistics by_path = render(scene, "path", "", {200, 1}).mean({""});
  EXPECT_NEAR(render(seen, "path", set("max_depth", 1), {4, 1}).mean({"emission"}).mean(), 4, 1e-5);
  EXPECT_EQ(render(scene, "path", set("max_depth", 1), {4, 1}).mean({"emission"}).mean(), 0);
  const auto check = [&](const char* integrator, double samples) {
    const Passes passes = render(scene, integrator, "", {samples, 2});
    EXPECT_EQ(passes.mean({"emission"}).mean(), 0) << integrator;
    expect_equal_means(integrator, passes.mean({""}), by_path);
  };
  check("lighttracer", 400);
  check("bdpt", 150);
  for (const char* integrator : {"vcm", "auto"})
    expect_near_means(integrator, render(scene, integrator, "", {100, 3}).mean({""}), by_path,
                      0.01);
}

/// The same patch of the wall, seen from before the lamp and through it.
TEST(HiddenLamps, ChangeNothingOfWhatIsBehindThem) {
  const TestScene through(camera("0, 0, 1.1", "0, 0, 0", 20 * 0.9 / 1.1, 8, "0, 1, 0") +
                          lamp_before_wall(hidden).substr(lamp_before_wall(hidden).find("<shape")));
  const TestScene before(wall_before_lamp());
  expect_equal_means("direct light",
                     render(through, "path", set("max_depth", 2), {400, 5}).mean({"direct"}),
                     render(before, "path", set("max_depth", 2), {400, 6}).mean({"direct"}));
}

TEST(HiddenLamps, AreSeenInMirrorsAndThroughGlass) {
  const std::string mirrored = camera("0, 0, 2", "0, 0, 0", 10, 8, "0, 1, 0") +
                               flat("rectangle", scale("4, 4, 1"), mirror()) +
                               flat("rectangle", scale("9, 9, 1") + translate("0, 0, 3"),
                                    square_lamp(hidden) + diffuse("0"));
  EXPECT_NEAR(render(TestScene(mirrored), "path", "", {4, 1}).mean({""}).mean(), 4, 1e-3);
  const std::string glazed =
      camera("0, 0, 4", "0, 0, 0", 10, 8, "0, 1, 0") +
      flat("rectangle", scale("9, 9, 1") + translate("0, 0, 2"), glass(1.0)) +
      flat("rectangle", scale("9, 9, 1"), square_lamp(hidden) + diffuse("0"));
  EXPECT_NEAR(render(TestScene(glazed), "path", "", {4, 1}).mean({""}).mean(), 4, 1e-3);
}

/// They are there for all others: light of other lamps does not pass them.
TEST(HiddenLamps, ThrowShadows) {
  const std::string lit = camera("0, -3, 3", "0, 0, 0", 8, 8) +
                          flat("rectangle", scale("4, 4, 1"), diffuse("0.5")) +
                          point_light("0, 0, 3", 10);
  const std::string screen =
      flat("rectangle", scale("0.8, 0.8, 1") + translate("0, 0, 1.5"),
           diffuse("0") + R"(<emitter type="area"><rgb name="radiance" value="0"/>)" + hidden +
               "</emitter>");
  EXPECT_GT(render(TestScene(lit), "path", set("max_depth", 2), {4, 1}).mean({"direct"}).mean(),
            0.05);
  EXPECT_EQ(
      render(TestScene(lit + screen), "path", set("max_depth", 2), {4, 1}).mean({"direct"}).mean(),
      0);
}

TEST(HiddenLamps, SurroundingsMayBeBlackForTheCamera) {
  const auto around = [](const std::string& more) {
    return camera("0, 0, 4", "0, 0, 0", 40, 16, "0, 1, 0") +
           sphere("0, 0, 0", 0.8, diffuse("0.5")) +
           R"(<emitter type="constant"><rgb name="radiance" value="2"/>)" + more + "</emitter>";
  };
  for (const char* integrator : {"path", "vcm"}) {
    const Passes seen = render(TestScene(around("")), integrator, "", {64, 1}),
                 black = render(TestScene(around(hidden)), integrator, "", {64, 1});
    EXPECT_GT(seen.mean({"emission"}).mean(), 0.5) << integrator;
    EXPECT_EQ(black.mean({"emission"}).mean(), 0) << integrator;
    EXPECT_NEAR(black.mean({"direct"}).mean(), seen.mean({"direct"}).mean(), 0.01) << integrator;
  }
}

/// The integrator may hide them all; that of a shape is not asked.
TEST(HiddenLamps, MayBeAllByTheIntegrator) {
  const auto emission = [](const std::string& integrator) {
    const TestScene scene(lamp_before_wall("") + integrator);
    return render(scene, "path", set("max_depth", 1), {4, 1}).mean({"emission"}).mean();
  };
  EXPECT_NEAR(emission(""), 4, 1e-5);
  EXPECT_NEAR(
      emission("<integrator type=\"path\">" + set("hide_emitters", false) + "</integrator>"), 4,
      1e-5);
  EXPECT_EQ(
      emission("<integrator type=\"volpath\">" + set("hide_emitters", true) + "</integrator>"), 0);
  EXPECT_EQ(emission("<integrator type=\"aov\"><integrator type=\"path\">" +
                     set("hide_emitters", true) + "</integrator></integrator>"),
            0);
}

}  // namespace
}  // namespace kaustik
