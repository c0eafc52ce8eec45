// Integrators that are presets of others are those to the bit, and what scenes change of settings.
#include <algorithm>

#include "kaustik/render/session.h"
#include "kaustik/vcm/settings.h"
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

/// A table is known by its name: registries copy tables.
TEST(Presets, AutoIsKnownByItsName) {
  Problems problems;
  const TypeInfo copy = auto_info();
  const VcmSettings settings(Arguments(copy, {}, {}, problems));
  EXPECT_TRUE(settings.chooses_light_paths && settings.techniques.merging);
}

/// What media that scatter change of the settings is told; of what was asked for otherwise the user
/// is warned.
TEST(Presets, WhatMediaChangeIsTold) {
  const auto fog = [](double albedo) {
    return camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 8) +
           flat("rectangle", "", diffuse("0.5, 0.5, 0.5")) + point_light("0, 0, 1", 3) +
           sphere("0, 0, 0.5", 0.3,
                  fmt::format("<bsdf type=\"null\"/><medium name=\"interior\" "
                              "type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"1, 1, 1\"/>"
                              "<rgb name=\"albedo\" value=\"{0}, {0}, {0}\"/></medium>",
                              albedo));
  };
  const auto told = [](const TestScene& scene, const std::string& type,
                       const std::string& parameters) {
    const auto integrator = scene.integrator(type, parameters);
    SplatBuffer splats(scene.scene().film(), integrator->traits().components);
    return integrator->prepare({1, 0, 4, {}}, splats, {}, {})->report;
  };
  const auto of_media = [](const PassReport& report) {
    return std::count_if(
        report.decisions.begin(), report.decisions.end(),
        [](const std::string& text) { return text.find("media scatter light") == 0; });
  };
  const TestScene scattering(fog(0.5)), clear(fog(0));
  EXPECT_EQ(of_media(told(scattering, "auto", "")), 2);
  EXPECT_EQ(of_media(told(scattering, "ppm", "")), 1);
  EXPECT_EQ(of_media(told(scattering, "ppm", set("guiding", false))), 0);
  EXPECT_EQ(of_media(told(clear, "auto", "")), 0);
  for (const auto& [parameters, warnings] :
       {std::pair(set("guiding", true), 1),
        {set("guiding", true) + set("guided_scattering", true), 2},
        {set("guiding", false), 0},
        {std::string(), 0},
        {set("choose_light_paths", true) + set("splats", false), 1}}) {
    EXPECT_EQ(told(scattering, "ppm", parameters).warnings.size(), size_t(warnings)) << parameters;
    EXPECT_TRUE(told(clear, "ppm", parameters).warnings.empty()) << parameters;
  }
}

}  // namespace
}  // namespace kaustik
