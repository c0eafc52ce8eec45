// What light paths learn from those that reach what the camera sees.

#include "kaustik/vcm/lessons/light_path_use.h"

#include "kaustik/vcm/light_pass.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string block(const std::string& size, const std::string& at) {
  return flat("cube", scale(size) + translate(at), diffuse("0.6, 0.55, 0.5"));
}

/// A court without a roof, 4 m wide, on a floor 80 m wide under the sun: 0.3 % of it.
std::string court() {
  return camera("0.3, -1.6, 1.5", "0, 0, 0.3", 60, 64) +
         flat("rectangle", scale("40, 40, 1"), diffuse("0.5, 0.45, 0.4")) +
         block("2.2, 0.1, 1.5", "0, 2.1, 1.5") + block("2.2, 0.1, 1.5", "0, -2.1, 1.5") +
         block("0.1, 2.2, 1.5", "-2.1, 0, 1.5") + block("0.1, 2.2, 1.5", "2.1, 0, 1.5") +
         directional_light("0.3, 0.35, -1", 2);
}

/// A hall of fifty lamps, one of which hangs over a pool behind walls that reach up to it.
std::string pool_in_a_hall() {
  std::string text = camera("1.5, -1.5, 1.8", "0, 0, 0", 55, 64) +
                     flat("rectangle", scale("20, 20, 1"), diffuse("0.5, 0.6, 0.7")) +
                     flat("rectangle", scale("2, 2, 1") + translate("0, 0, 0.5"), glass(1.33)) +
                     block("2.2, 0.1, 2", "0, 2.1, 2") + block("2.2, 0.1, 2", "0, -2.1, 2") +
                     block("0.1, 2.2, 2", "-2.1, 0, 2") + block("0.1, 2.2, 2", "2.1, 0, 2");
  for (int i = 0; i < 50; ++i)
    text += flat("rectangle",
                 scale("0.1, 0.1, 1") + rotate("1, 0, 0", 180) +
                     translate(fmt::format("{}, {}, 3.9", 4 * (i % 10 - 5), 4 * (i / 10 - 2))),
                 diffuse("0, 0, 0") + area_light("20"));
  return text;
}

struct UsefulPaths {
  size_t plain = 0, learned = 0;
};

/// Of 2¹⁵ paths those that were of use, without what was learned from a search and with it.
UsefulPaths useful_paths(const std::string& text) {
  const TestScene test_scene(text);
  const Scene& scene = test_scene.scene();
  const LightPathEmission plain(scene);
  PathWeights::Settings settings;
  settings.techniques.merging = true;
  const PathWeights weights(settings);
  SplatBuffer nowhere = SplatBuffer::nowhere();
  const auto paths = [&](const LightPathEmission& emission, uint32_t index) {
    Pass pass;
    pass.index = index;
    PassReport report;
    return trace_light_vertices({.scene = scene,
                                 .emission = emission,
                                 .weights = weights,
                                 .maximum_events = 100,
                                 .light_paths = LightPathUse::most_paths,
                                 .plans = PixelPlans(),
                                 .remembered_paths = LightPathUse::most_paths},
                                pass, Stream::training, nowhere, {}, {}, report);
  };
  LightPathUse use(scene, plain, ComponentSet::all());
  use.learn(paths(LightPathEmission(plain, use.targets()), 0), {});
  auto learned = use.emission().learned();
  if (!learned) return {};
  use.learn(paths(*learned, 1), {});
  learned = use.emission().learned();
  const auto count = [&](const LightPathEmission& emission) {
    LightPathUse counted(scene, plain, ComponentSet::all());
    counted.learn(paths(emission, 2), {});
    return counted.emission().size();
  };
  return learned ? UsefulPaths{count(plain), count(*learned)} : UsefulPaths();
}

TEST(LightPathUse, MorePathsAreOfUse) {
  const struct {
    const char* name;
    std::string scene;
    double factor;
  } rows[] = {{"a court in the open", court(), 40},
              {"a pool among fifty lamps", pool_in_a_hall(), 15}};
  for (const auto& row : rows) {
    const UsefulPaths found = useful_paths(row.scene);
    std::printf("  %-30s %zu of 32768 paths are of use, %zu once they have learned\n", row.name,
                found.plain, found.learned);
    EXPECT_GT(double(found.learned), row.factor * double(found.plain)) << row.name;
  }
}

/// Guided paths tell the noise of paths that are not, as those do where they find enough.
TEST(LightPathUse, NoiseOfUnguidedPathsLong) {
  const TestScene test_scene(camera("0, -3, 2", "0, 0, 0.2", 45, 32) +
                             flat("rectangle", scale("1, 1, 1"), diffuse("0.6, 0.5, 0.4")) +
                             sphere("-0.4, 0, 0.35", 0.35, diffuse("0.7, 0.3, 0.3")) +
                             block("0.25, 0.25, 0.4", "0.5, 0.3, 0.4") +
                             point_light("0, 0.5, 2.5", 10));
  const Scene& scene = test_scene.scene();
  const LightPathEmission plain(scene);
  PathWeights::Settings settings;
  settings.techniques.merging = true;
  const PathWeights weights(settings);
  SplatBuffer nowhere = SplatBuffer::nowhere();
  const auto paths = [&](const ScatterGuide* guide, uint32_t index) {
    Pass pass;
    pass.index = index;
    PassReport report;
    return trace_light_vertices({.scene = scene,
                                 .emission = plain,
                                 .weights = weights,
                                 .maximum_events = 100,
                                 .light_paths = LightPathUse::most_pilot_paths,
                                 .plans = PixelPlans(),
                                 .remembered_paths = LightPathUse::most_pilot_paths,
                                 .scattering = guide,
                                 .remembers_scattering = true},
                                pass, Stream::training, nowhere, {}, {}, report);
  };
  LightPathUse use(scene, plain, ComponentSet::all());
  use.learn(paths(nullptr, 0), {});
  const auto guide = use.scattering().learned();
  ASSERT_TRUE(guide);
  RunningStatistics unguided, by_guided, guided;
  for (uint32_t i = 1; i <= 48; ++i) {
    use.learn_scattering(paths(nullptr, i), {});
    EXPECT_EQ(use.noise().guided, use.noise().unguided);
    unguided.add(use.noise().guided);
    use.learn_scattering(paths(guide.get(), i), {});
    by_guided.add(use.noise().unguided);
    guided.add(use.noise().guided);
  }
  expect_near_means("noise of unguided paths", Comparison(by_guided, unguided), 0.03, 0.03);
  EXPECT_LT(guided.mean(), 0.9 * unguided.mean());
}

}  // namespace
}  // namespace kaustik
