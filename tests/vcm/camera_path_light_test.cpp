// Every way of finding light by camera paths, alone and with the others, finds all of it.

#include "tests/vcm/ball_camera_paths.h"

namespace kaustik {
namespace {

using namespace test;

struct BallTechniques {
  const char* name;
  Techniques on;
  bool finds_direct;
};
void PrintTo(const BallTechniques& techniques, std::ostream* out) { *out << techniques.name; }

/// unidirectional, next_event, splats, connections, merging.
const BallTechniques ball_techniques[] = {
    {"sampling", {false, true, false, false, false}, true},
    {"splats", {false, false, true, false, false}, false},
    {"connections", {false, false, false, true, false}, false},
    {"merging", {false, false, false, false, true}, false},
    {"sampling_and_merging", {false, true, false, false, true}, true},
    {"all", {true, true, true, true, true}, true}};

class CameraPathTechniques : public testing::TestWithParam<BallTechniques> {};

/// Each way of finding light alone, and all together, finds all of it: direct light, which is
/// sampled, and what comes by more events. Paths that go on are few, and count for more.
TEST_P(CameraPathTechniques, FindAllLight) {
  const HollowBall ball;
  constexpr uint32_t light_paths = slow_build ? 2000 : 12000;
  PathWeights::Settings settings;
  settings.techniques = GetParam().on;
  settings.light_paths = light_paths;
  settings.connections = float(1 - HollowBall::albedo);  // over the vertices of a light path
  settings.merge_area = pi * sqr(0.06f);
  settings.accepted_area = 0.05f;
  BallCameraPaths paths(
      ball, PathWeights(settings),
      {.merge_area = settings.merge_area, .survival = 0.6f, .evenness = 1.2f, .light_samples = 3});
  RunningStatistics direct, indirect;
  for (uint32_t number = 0; number < measured_passes; ++number) {
    paths.begin(light_paths, number, 1 << 20);
    RunningStatistics of_direct, of_indirect;
    paths.for_samples([&](const Vec2f& raster, Sampler& sampler) {
      SampleSink sink(ComponentSet::all());
      trace_camera_path(paths.inputs(), paths.plan(), raster, sampler, sink);
      of_direct.add(light_in(sink, Component::direct));
      of_indirect.add(light_in(sink, Component::indirect));
    });
    direct.add(of_direct.mean());
    indirect.add(of_indirect.mean() + paths.splatted());
  }
  const double expected = GetParam().finds_direct ? HollowBall::radiance(1) : 0;
  EXPECT_NEAR(direct.mean(), expected, 1e-4 * expected);
  expect_known_mean(GetParam().name, indirect, HollowBall::radiance_from(2), 0.06);
}
INSTANTIATE_TEST_SUITE_P(Ball, CameraPathTechniques, testing::ValuesIn(ball_techniques),
                         [](const auto& of) { return of.param.name; });

/// A ball whose wall shines: radiance e/(1 − albedo) wherever one looks, by light that is met, that
/// is sampled, and both with light paths.
TEST(CameraPath, MeetsAndSamplesTheLightOfAFurnace) {
  const TestScene furnace(camera("0.2, -0.75, 0.1", "0, 1, 0.1", 100, 16) +
                          sphere("0, 0, 0", 1, diffuse("0.6, 0.6, 0.6") + area_light("1"), true));
  const LightPathEmission emission(furnace.scene());
  PixelPlans plans(furnace.scene());
  constexpr uint32_t light_paths = slow_build ? 1000 : 6000;
  const struct {
    const char* name;
    Techniques on;
  } rows[] = {{"met", {true, false, false, false, false}},
              {"sampled", {false, true, false, false, false}},
              {"both", {true, true, false, false, false}},
              {"both and merged", {true, true, false, false, true}},
              {"both and connected", {true, true, false, true, false}}};
  for (const auto& row : rows) {
    PathWeights::Settings settings;
    settings.techniques = row.on;
    settings.light_paths = light_paths;
    settings.connections = 0.4f;
    settings.merge_area = pi * sqr(0.06f);
    settings.accepted_area = 0.05f;
    const PathWeights weights(settings);
    const PixelPlan plan{.merge_area = settings.merge_area,
                         .survival = 0.6f,
                         .glossy_survival = 0.9f,
                         .evenness = 1.2f,
                         .light_samples = 3};
    RunningStatistics all;
    for (uint32_t number = 0; number < measured_passes; ++number) {
      SplatBuffer nowhere(furnace.scene().film(), ComponentSet());
      PassReport report;
      const LightVertices light =
          trace_light_vertices({.scene = furnace.scene(),
                                .emission = emission,
                                .weights = weights,
                                .light_paths = light_paths,
                                .camera_samples = 4,
                                .plans = plans},
                               Pass{1, number, 1}, Stream::light_path, nowhere, {}, {}, report);
      const MattMerging matt(light, weights);
      const CameraPathInputs inputs{
          .scene = furnace.scene(),
          .emission = emission,
          .weights = weights,
          .light = light,
          .matt = matt,
          .seen = plans.seen(),
          .camera_samples = 4,
          .connection_scale = float(double(light.connectible.size()) / double(light_paths)),
          .merge_radius_sq = settings.merge_area * inv_pi};
      RunningStatistics of_pass;
      for (uint32_t i = 0; i < 512; ++i) {
        Sampler sampler = Sampler::at(3, number, Stream::camera, i, 0);
        const Vec2f raster = sampler.next_2d() * 16.0f;
        SampleSink sink(ComponentSet::all());
        trace_camera_path(inputs, plan, raster, sampler, sink);
        of_pass.add(light_in(sink));
      }
      all.add(of_pass.mean());
    }
    expect_known_mean(row.name, all, 3 / (1 - 0.6), 0.06);
  }
}

}  // namespace
}  // namespace kaustik
