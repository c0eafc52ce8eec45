// The cache of indirect light in a furnace, where all of it is known.

#include "kaustik/vcm/gathering/indirect_cache.h"
#include "kaustik/vcm/plan/cache_trial.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr double furnace_albedo = 0.5;

/// A closed ball that emits 1 everywhere: after each event `furnace_albedo` times as much light is
/// left.
TestScene matt_furnace() {
  return TestScene(camera("0.2, 0.1, -0.3", "1, 0.3, 0.2", 80, 64) +
                   sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5") + area_light("1, 1, 1"), true));
}

struct Served {
  double share = 0;  ///< of the places
  RunningStatistics radiance;
};

/// What caches of some passes have at places all over the picture.
Served served_by(const Scene& scene, int maximum_events, uint32_t passes) {
  Served result;
  const LightVertices no_light;
  const SidedTree<LightVertexData> nothing_focused;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    IndirectCache cache({.scene = scene,
                         .light = no_light,
                         .focused = nothing_focused,
                         .maximum_events = maximum_events},
                        {0, pass, 1}, 0, 128);
    for (int round = 0; round < IndirectCache::most_rounds; ++round) cache.fill_round({});
    double sum = 0;
    int found = 0;
    constexpr int side = 16;
    for (int i = 0; i < side * side; ++i) {
      Sampler numbers = Sampler::at(0, 0, Stream::camera, uint64_t(i), 0);
      SampleSink nowhere{ComponentSet()};
      CameraWalk walk(scene, Vec2f(float(i % side) + 0.5f, float(i / side) + 0.5f) * 4, numbers,
                      nowhere);
      Spectrum radiance;
      EXPECT_TRUE(walk.advance() && IndirectCache::is_for(walk, any_number_of_events));
      if (!cache.reflected(walk, radiance)) continue;
      sum += double(radiance[0]);
      ++found;
    }
    result.share += double(found) / (side * side) / passes;
    if (found > 0) result.radiance.add(sum / found);
  }
  return result;
}

TEST(IndirectCache, HasTheLightOfAFurnace) {
  const TestScene scene = matt_furnace();
  const Served served = served_by(scene.scene(), 1 << 20, slow_build ? 8 : 64);
  EXPECT_GT(served.share, 0.9);
  const double expected = furnace_albedo * furnace_albedo / (1 - furnace_albedo);
  EXPECT_NEAR(served.radiance.mean(), expected,
              4 * served.radiance.standard_error() + 0.002 * expected);
  EXPECT_LT(served.radiance.standard_error(), 0.01 * expected);
}

/// Of one event more than direct light, of two.
TEST(IndirectCache, CountsEvents) {
  const TestScene scene = matt_furnace();
  for (const int most : {1, 2, 3}) {
    const Served served = served_by(scene.scene(), most, slow_build ? 8 : 32);
    double expected = 0;
    for (int events = 2; events <= most; ++events) expected += std::pow(furnace_albedo, events);
    EXPECT_NEAR(served.radiance.mean(), expected, 4 * served.radiance.standard_error() + 1e-3)
        << most;
  }
}

TEST(IndirectCache, IsForMattSurfacesThatTheCameraSees) {
  const auto is_for = [](const std::string& bsdf) {
    const TestScene scene(camera("0, 0, 2", "0, 0, 0", 30, 8, "0, 1, 0") +
                          flat("rectangle", "", bsdf));
    Sampler numbers = Sampler::at(0, 0, Stream::camera, 0, 0);
    SampleSink nowhere{ComponentSet()};
    CameraWalk walk(scene.scene(), {4, 4}, numbers, nowhere);
    EXPECT_TRUE(walk.advance());
    return IndirectCache::is_for(walk, any_number_of_events);
  };
  EXPECT_TRUE(is_for(diffuse("0.5, 0.5, 0.5")));
  EXPECT_TRUE(is_for(phong(0.4, 0.3, 20)));
  EXPECT_FALSE(is_for(mirror()));
  EXPECT_FALSE(is_for(glass()));
}

/// Mirrors and clear glass show matt surfaces, what scatters light by a glossy lobe does not.
/// Records do not know how many events there are before them.
TEST(IndirectCache, IsForWhatMirrorsShow) {
  const auto finds = [](const std::string& first, int maximum_events = any_number_of_events) {
    const TestScene scene(
        camera("0, 0, 2", "0, 0, 0", 30, 8, "0, 1, 0") + flat("rectangle", "", first) +
        flat("rectangle", rotate("1, 0, 0", 180) + translate("0, 0, 3"), diffuse("0.5, 0.5, 0.5")));
    Sampler numbers = Sampler::at(0, 0, Stream::camera, 0, 0);
    SampleSink nowhere{ComponentSet()};
    CameraWalk walk(scene.scene(), {4, 4}, numbers, nowhere);
    return IndirectCache::advance_to_vertex(walk, maximum_events);
  };
  EXPECT_TRUE(finds(diffuse("0.5, 0.5, 0.5")));
  EXPECT_TRUE(finds(diffuse("0.5, 0.5, 0.5"), 3));
  EXPECT_TRUE(finds(mirror()));
  EXPECT_FALSE(finds(mirror(), 3));
  EXPECT_FALSE(finds(R"(<bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf>)"));
}

/// Where the camera sees the furnace in a mirror or through clear glass, it has the light of what
/// is seen. They are so small that gather rays hardly ever meet them.
TEST(IndirectCache, HasTheLightThatMirrorsShow) {
  for (const std::string& bsdf : {mirror(), glass(1.0)}) {
    const TestScene scene(
        camera("0, 0, 0", "1, 0, 0", 20, 32) +
        flat("rectangle", scale("0.06, 0.06, 1") + rotate("0, 1, 0", -90) + translate("0.3, 0, 0"),
             bsdf) +
        sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5") + area_light("1, 1, 1"), true));
    const LightVertices no_light;
    const SidedTree<LightVertexData> nothing_focused;
    IndirectCache cache({.scene = scene.scene(), .light = no_light, .focused = nothing_focused},
                        {0, 0, 1}, 0, 128);
    for (int round = 0; round < IndirectCache::most_rounds; ++round) cache.fill_round({});
    int served = 0, mirrored = 0;
    double sum = 0;
    for (uint32_t i = 0; i < 64; ++i) {
      Sampler numbers = Sampler::at(0, 0, Stream::camera, i, 0);
      SampleSink nowhere{ComponentSet()};
      CameraWalk walk(scene.scene(), numbers.next_2d() * 32, numbers, nowhere);
      if (!IndirectCache::advance_to_vertex(walk, any_number_of_events)) continue;
      if (walk.events() == 0) continue;
      ++mirrored;
      Spectrum radiance;
      if (!cache.reflected(walk, radiance)) continue;
      ++served;
      sum += double(radiance[0]);
    }
    EXPECT_GT(mirrored, 20);
    EXPECT_GT(served, 0.7 * mirrored);
    EXPECT_NEAR(sum / served, furnace_albedo * furnace_albedo / (1 - furnace_albedo), 0.05) << bsdf;
  }
}

/// What two caches with few gather rays tell of variance and cost is that of caches with as many as
/// passes have.
TEST(CacheTrial, KnowsTheVarianceOfCaches) {
  const TestScene scene(camera("0.2, -0.1, -0.3", "1, 0.3, 0.2", 80, slow_build ? 96 : 192) +
                        sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) +
                        sphere("-0.4, 0.3, 0.1", 0.2f, area_light("1, 1, 1")));
  const LightVertices no_light;
  const SidedTree<LightVertexData> nothing_focused;
  const GatherInputs inputs{.scene = scene.scene(), .light = no_light, .focused = nothing_focused};
  const PixelPlans plans(scene.scene());
  constexpr int gather_rays = 128;
  TrialCaches trial_caches(inputs, plans, {});
  const CacheTrial trial = trial_caches.next_round({});
  EXPECT_EQ(trial.served.size(), plans.plans().size());
  EXPECT_GT(trial.rays_per_ray, 0);
  // The same at the probes, by first passes of other seeds.
  const size_t probes = trial.served.size();
  std::vector<RunningStatistics> light(probes);
  double rays = 0;
  constexpr uint32_t passes = slow_build ? 6 : 24;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    IndirectCache cache(inputs, {5 + pass, 0, 1}, 0, gather_rays);
    cache.fill_round({});
    rays += double(cache.rays()) / passes;
    for (size_t i = 0; i < probes; ++i) {
      Sampler numbers = Sampler::at(0, 0, Stream::camera, i, 0);
      SampleSink nowhere{ComponentSet()};
      CameraWalk walk(scene.scene(), plans.seen().probes()[i].raster, numbers, nowhere);
      Spectrum radiance;
      if (IndirectCache::advance_to_vertex(walk, any_number_of_events) &&
          cache.reflected(walk, radiance))
        light[i].add(double(radiance.sum()));
    }
  }
  double expected = 0, found = 0, served = 0, by_light = 0;
  for (size_t i = 0; i < probes; ++i) {
    if (!trial.served[i] || light[i].count() < passes) continue;
    ++served;
    expected += double(trial.ray_variance[i]) / gather_rays;
    by_light += double(trial.light_variance[i]);
    found += light[i].variance();
  }
  EXPECT_GT(served, 30);
  std::printf("  variance of a cache, by a trial %.3g, over that by passes, %.3g: %.2f\n", expected,
              found, expected / found);
  // Neighbours have their noise in common, which counts up to 2.7 times. More rays stratify one
  // another better than few do.
  EXPECT_GT(expected / found, 0.8);
  EXPECT_LT(expected / found, 4);
  EXPECT_EQ(by_light, 0);  // there are no light paths whose noise it could be
  EXPECT_NEAR(trial.rays_per_ray * gather_rays / rays, 1, 0.4);
}

}  // namespace
}  // namespace kaustik
