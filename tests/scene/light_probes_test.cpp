// What a scene learns of its lights.

#include "kaustik/scene/light_probes.h"

#include "tests/scene/scene_support.h"

namespace kaustik {
namespace {

using namespace test;

std::string box(double x) {
  return "<shape type=\"cube\"><transform name=\"to_world\"><translate x=\"" + std::to_string(x) +
         "\"/></transform></shape>";
}
std::string lamp(double x, double intensity = 1) {
  return "<emitter type=\"point\"><point name=\"position\" x=\"" + std::to_string(x) +
         "\" y=\"0.5\" z=\"0\"/><rgb name=\"intensity\" value=\"" + std::to_string(intensity) +
         "\"/></emitter>";
}
/// Of the rays that build_scene's probes trace, the observer sees none.
class Counter final : public RayObserver {
 public:
  void on_ray(const Ray&, bool) override { ++rays; }
  int rays = 0;
};

/// The camera's room has a dim lamp, the next one a bright lamp.
const std::string two_rooms =
    std::string(any_camera) + box(0) + box(2.01) + lamp(0.2) + lamp(2, 50);

TEST(LightProbes, LampsBehindWallsAreHardlyChosen) {
  const auto scene = scene_of(two_rooms);
  const Vec3f floor(0.3f, -1, 0.2f), up(0, 1, 0);
  const LightSelector ignorant(scene->lights());
  const float by_promise = ignorant.probability(floor, up, 0);
  EXPECT_LT(by_promise, 0.3f);
  EXPECT_GT(scene->light_selector().probability(floor, up, 0), 3 * by_promise);
  EXPECT_GT(scene->light_selector().probability(floor, up, 1), 0.0f);
}

TEST(LightProbes, AreTheSameEveryTimeAndSeenByNobody) {
  Counter counter;
  BuildOptions options;
  options.observer = &counter;
  const auto a = build_scene(description_of(two_rooms), options);
  EXPECT_EQ(counter.rays, 0);
  const auto b = scene_of(two_rooms);
  for (int i = 0; i < 100; ++i) {
    const Vec3f at(0.02f * float(i) - 1, -1, 0.1f);
    EXPECT_EQ(a->light_selector().probability(at, {0, 1, 0}, 0),
              b->light_selector().probability(at, {0, 1, 0}, 0));
  }
}

TEST(LightProbes, LearnNothingBehindNullBoundaries) {
  const auto scene = scene_of(two_rooms +
                              "<shape type=\"sphere\"><float name=\"radius\" value=\"0.1\"/>"
                              "<bsdf type=\"null\"/></shape>");
  EXPECT_TRUE(probe_lights(*scene).empty());
  EXPECT_FALSE(probe_lights(*scene_of(two_rooms)).empty());
  EXPECT_TRUE(probe_lights(*scene_of(any_camera + box(0) + lamp(0))).empty());
}

}  // namespace
}  // namespace kaustik
