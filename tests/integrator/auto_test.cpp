// The default integrator: what it decides, and that it makes the picture that all others make.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A closed room 2 m wide.
std::string room(const std::string& inside, int size) {
  const std::string white = diffuse("0.6, 0.6, 0.6");
  return camera("0, -0.9, 0.9", "0, 1, 0.6", 65, size) + flat("rectangle", "", white) +
         flat("rectangle", rotate("1, 0, 0", 180) + translate("0, 0, 2"), white) +
         flat("rectangle", rotate("0, 1, 0", 90) + translate("-1, 0, 1"), white) +
         flat("rectangle", rotate("0, 1, 0", -90) + translate("1, 0, 1"), white) +
         flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"), white) +
         flat("rectangle", rotate("1, 0, 0", -90) + translate("0, -1, 1"), white) + inside;
}
std::string lamp(const std::string& transform, double radiance) {
  return flat("rectangle", transform, diffuse("0, 0, 0") + area_light(std::to_string(radiance)));
}
const std::string ceiling =
    scale("0.4, 0.4, 1") + rotate("1, 0, 0", 180) + translate("0, 0.2, 1.95");

/// Shines at the ceiling from behind a screen: all light is indirect.
std::string hidden_lamp() {
  return lamp(scale("0.1, 0.1, 1") + translate("0, 0.8, 0.3"), 40) +
         flat("rectangle", scale("0.4, 0.3, 1") + rotate("1, 0, 0", 90) + translate("0, 0.6, 0.3"),
              diffuse("0.2, 0.2, 0.2"));
}

std::string decision(const std::string& scene_text) {
  const TestScene scene(scene_text);
  const auto integrator = scene.integrator("auto");
  SessionSettings settings;
  settings.passes = 1;
  settings.samples_per_pixel = 4;
  Session session(scene.scene(), *integrator, settings);
  const SessionReport report = session.run();
  EXPECT_EQ(report.decisions.size(), 1u);
  return report.decisions.empty() ? "" : report.decisions[0];
}
/// Of "camera paths go on in 12 % of cases".
int going_on(const std::string& decision) {
  const std::string before = "go on in ";
  const size_t at = decision.find(before);
  if (at == std::string::npos) return -1;
  return std::stoi(decision.substr(at + before.size()));
}

/// Three scenes, three choices.
TEST(Auto, DecidesByTheScene) {
  const std::string open =
      decision(camera("0, -3, 1.5", "0, 0, 0", 40, 64) +
               flat("rectangle", scale("3, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
               sphere("0, 0, 0.5", 0.5, diffuse("0.7, 0.3, 0.3")) + constant_light(1));
  EXPECT_NE(open.find("camera alone"), std::string::npos) << open;
  const std::string hidden = decision(room(hidden_lamp(), 64));
  EXPECT_LT(going_on(hidden), 15) << hidden;
  EXPECT_GE(going_on(hidden), 2) << hidden;
  // A caustic on a floor under an even sky: paths for the sky, light paths for the lamp.
  const std::string both =
      decision(camera("0, -3, 1.5", "0, 0, 0", 40, 64) +
               flat("rectangle", scale("3, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
               sphere("0, 0, 0.6", 0.5, glass()) + constant_light(1) +
               sphere("0, 0, 4", 0.05, diffuse("0, 0, 0") + area_light("3000")));
  EXPECT_GT(going_on(both), 60) << both;
}

/// Where light paths do not pay, finding that out takes less than a twentieth of the rays of 16
/// passes.
TEST(Auto, PilotIsCheap) {
  const TestScene scene(camera("0, -3, 1.5", "0, 0, 0", 40, 128) +
                        flat("rectangle", scale("3, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
                        sphere("0, 0, 0.5", 0.5, diffuse("0.7, 0.3, 0.3")) + constant_light(1));
  const auto rays_of = [&](const char* type, const std::string& parameters) {
    const auto integrator = scene.integrator(type, parameters);
    SessionSettings settings;
    settings.passes = 16;
    settings.samples_per_pass = 4;
    Session session(scene.scene(), *integrator, settings);
    return double(session.run().rays);
  };
  const double alone =
      rays_of("vcm", set("splats", false) + set("connections", false) + set("merging", false));
  const double found_out = rays_of("auto", "");
  EXPECT_GT(found_out, alone);
  EXPECT_LT(found_out, 1.05 * alone) << found_out / alone;
}

TEST(Auto, MakesThePictureOfPath) {
  const TestScene scene(room(lamp(ceiling, 8) + sphere("-0.4, 0.4, 0.351", 0.35, mirror()) +
                                 sphere("0.4, 0.2, 0.301", 0.3, glass()),
                             16));
  const std::string components = set("components", "direct,indirect");
  const Passes path = render(scene, "path", components, {400, 7});
  const Passes found = render(scene, "auto", components, {160, 8});
  for (const char* layer : {"direct", "indirect"})
    expect_near_means(fmt::format("auto {}", layer), found.mean({layer}), path.mean({layer}), 0.01);
}

TEST(Auto, HasNoBiasWithoutLightPaths) {
  const TestScene scene(camera("0, -3, 1.5", "0, 0, 0", 40, 16) +
                        flat("rectangle", scale("3, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
                        sphere("0, 0, 0.5", 0.5, diffuse("0.7, 0.3, 0.3")) + constant_light(1));
  const Passes path = render(scene, "path", "", {64, 7});
  const Passes found = render(scene, "auto", "", {64, 8});
  for (const char* layer : {"", "direct"})
    expect_equal_means(fmt::format("auto {}", layer), found.mean({layer}), path.mean({layer}));
}

TEST(Auto, IsTheDefault) {
  const std::string floor = camera("0, 0, 3", "0, 0, 0", 40, 8, "0, 1, 0") + constant_light(1);
  const Description plain = description_of(floor + flat("rectangle", "", diffuse("0.5, 0.5, 0.5")));
  EXPECT_EQ(integrator_type(plain, TestScene(plain).scene()), "auto");
  // Surfaces with models of their own would be ignored by it.
  const Description modelled =
      description_of(floor + flat("rectangle", "",
                                  diffuse("0.5, 0.5, 0.5") + "<integrator type=\"localphong\"/>"));
  EXPECT_EQ(integrator_type(modelled, TestScene(modelled).scene()), "photonmap");
  const Description named = description_of("<integrator type=\"path\"/>" + floor +
                                           flat("rectangle", "", diffuse("0.5, 0.5, 0.5")));
  EXPECT_EQ(integrator_type(named, TestScene(named).scene()), "path");
}

}  // namespace
}  // namespace kaustik
