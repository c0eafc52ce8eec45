// Integrators that are presets of others are those to the bit.
#include "kaustik/render/session.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

Image rendered(const TestScene& scene, const std::string& type, const std::string& parameters) {
  const auto integrator = scene.integrator(type, parameters);
  SessionSettings settings;
  settings.seed = 2;
  settings.passes = 5;
  settings.samples_per_pass = 4;
  Session session(scene.scene(), *integrator, settings);
  session.run();
  return session.film().image();
}

TestScene lit_room(const std::string& of_ball) {
  return TestScene(camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 20) +
                   flat("rectangle", "", diffuse("0.5, 0.5, 0.5")) +
                   flat("rectangle",
                        scale("0.1, 0.1, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.25"),
                        diffuse("0, 0, 0") + area_light("40, 36, 32")) +
                   sphere("0.2, -0.05, 0.401", 0.4, of_ball));
}

TEST(Presets, AutoIsPpmThatChoosesLightPaths) {
  for (const std::string& ball : {glass(), diffuse("0.2, 0.2, 0.2")}) {
    const TestScene scene = lit_room(ball);
    EXPECT_TRUE(same_bits(rendered(scene, "ppm", set("choose_light_paths", true)),
                          rendered(scene, "auto", "")));
  }
  // Where no light is focused and little scattered, it has none.
  const TestScene scene = lit_room(diffuse("0.2, 0.2, 0.2"));
  EXPECT_FALSE(same_bits(rendered(scene, "ppm", ""), rendered(scene, "auto", "")));
}

}  // namespace
}  // namespace kaustik
