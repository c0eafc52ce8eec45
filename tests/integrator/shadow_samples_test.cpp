// Numbers of shadow rays that follow the shadow: every integrator finds the same light with them,
// and less noise.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A glossy floor, a ball that throws shadows, a glowing ball that nothing meets and a disk.
std::string two_lamps(int shadow_samples) {
  const std::string samples = set("shadow_samples", shadow_samples);
  return camera("0, -3, 2.5", "0, 0, 0.2", 45, 12) +
         flat("rectangle", scale("4, 4, 1"), phong(0.5, 0.3, 20)) +
         sphere("0, 0, 0.6", 0.4, diffuse("0.6")) +
         R"(<emitter type="distributed"><point name="position" value="1, 0.3, 2"/>
         <float name="radius" value="0.3"/><float name="power" value="20"/>)" +
         samples + "</emitter>" +
         flat("disk", scale("0.3") + rotate("1, 0, 0", 180) + translate("-1, 0, 1.8"),
              R"(<emitter type="area"><rgb name="radiance" value="6"/>)" + samples + "</emitter>");
}

RunningStatistics mean(const TestScene& scene, const std::string& integrator,
                       const std::string& parameters, double samples, uint64_t seed) {
  return render(scene, integrator, parameters, {samples, seed}).mean({"direct"});
}

TEST(ShadowSamples, EveryIntegratorFindsTheSameLight) {
  const TestScene one(two_lamps(1)), many(two_lamps(16));
  const std::string all = set("components", "direct");
  const RunningStatistics by_one = mean(one, "path", all, 250, 1);
  const std::pair<std::string, std::string> integrators[] = {
      {"path", all},
      {"photonmap", all},
      {"photonmap", all + set("light_sampling", "all")},
      {"raytracing", all},
      {"localphong", all + set("light_samples", 3)}};
  uint64_t seed = 2;
  for (const auto& [integrator, parameters] : integrators) {
    const RunningStatistics by_many = mean(many, integrator, parameters, 32, seed++);
    expect_equal_means(integrator + " with up to 16 shadow rays", by_many, by_one);
  }
}

}  // namespace
}  // namespace kaustik
