// Direct light by one light for each sample or by every light: the same mean as path tracing.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A glossy floor, two balls that throw shadows, and `count` lamps of different brightness over it.
std::string lamps_over_a_floor(int count) {
  std::string text = camera("0, -6, 4", "0, 0, 0.3", 45, 12) +
                     flat("rectangle", scale("4, 4, 1"), phong(0.5, 0.3, 20)) +
                     sphere("-0.8, 0, 0.6", 0.5, diffuse("0.7, 0.7, 0.7")) +
                     sphere("0.9, -0.4, 0.4", 0.4, ggx(0.3));
  for (int i = 0; i < count; ++i) {
    const double x = 3 * std::cos(2.4 * i), y = 3 * std::sin(2.4 * i);
    text += sphere(fmt::format("{}, {}, {}", x, y, 1.5 + 0.2 * (i % 5)), 0.1 + 0.05 * (i % 3),
                   diffuse("0, 0, 0") + area_light(i % 4 == 0 ? "20, 20, 20" : "3, 3, 3"));
  }
  return text + point_light("0, 1, 3", 2) + constant_light(0.05);
}

/// Few lights are chosen by power, many by a tree: both tell how the samples are shared.
TEST(DirectLightSampling, EveryLightBringsWhatPathTracingFinds) {
  for (const int lamps : {1, 20}) {
    const TestScene scene(lamps_over_a_floor(lamps));
    const RunningStatistics by_path =
        render(scene, "path", set("components", "direct"), {lamps == 1 ? 60.0 : 100.0, 2})
            .mean({"direct"});
    for (const int samples : {1, 30}) {
      if (lamps == 1 && samples > 1) continue;
      const RunningStatistics by_all =
          render(scene, "photonmap",
                 set("components", "direct") + set("light_sampling", "all") +
                     set("light_samples", samples),
                 {24, 1})
              .mean({"direct"});
      expect_equal_means(fmt::format("{} lamps, {} samples", lamps, samples), by_all, by_path);
    }
  }
}

/// Gather rays sample every light as well.
TEST(DirectLightSampling, EveryLightAtGatherRays) {
  const TestScene scene(
      camera("0, -0.8, 0", "0, 1, -0.2", 75, 12) +
      sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) +
      sphere("0.1, 0.1, 0.6", 0.2, diffuse("0, 0, 0") + area_light("10, 10, 10")) +
      point_light("-0.3, 0.2, 0", 0.5));
  const auto indirect = [&](const char* integrator, const std::string& parameters, double samples) {
    return render(scene, integrator, set("components", "indirect") + parameters, {samples, 3})
        .mean({"indirect"});
  };
  const std::string photons =
      set("global_photons", 20'000) + set("global_neighbors", 12) + set("irradiance_cache", false);
  expect_near_means("gathered, every light",
                    indirect("photonmap", photons + set("light_sampling", "all"), 16),
                    indirect("path", "", 64), 0.005);
}

}  // namespace
}  // namespace kaustik
