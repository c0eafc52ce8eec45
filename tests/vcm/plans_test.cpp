// The planner: what it plans where the answer is known on paper, and that it plans the same again.

#include "kaustik/vcm/plan/plans.h"

#include "kaustik/base/parallel.h"
#include "kaustik/vcm/plan/cost_model.h"
#include "kaustik/vcm/plan/plan_selection.h"
#include "kaustik/vcm/plan/plans_file.h"
#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

VcmSettings settings_of(const TypeInfo& type) {
  Problems problems;
  return VcmSettings(Arguments(type, {}, {}, problems));
}

FirstPlans all_planned(const TestScene& test, const VcmSettings& settings, uint32_t samples = 4) {
  const auto plain = std::make_shared<const LightPathEmission>(test.scene(), settings.aim);
  return VcmPlanner(test.scene(), settings, plain).make(samples, {});
}
VcmPlans planned(const TestScene& test, const VcmSettings& settings, uint32_t samples = 4) {
  return *all_planned(test, settings, samples).plans;
}
VcmPlans planned(const std::string& inside, const TypeInfo& type) {
  return planned(TestScene(inside), settings_of(type));
}

std::vector<uint8_t> bytes_of(const VcmPlans& plans) {
  ByteWriter writer;
  write_plans(writer, plans);
  return writer.take();
}

std::string lamp_above(const std::string& radiance = "40, 36, 32") {
  return flat("rectangle",
              scale("0.1, 0.1, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.25"),
              diffuse("0, 0, 0") + area_light(radiance));
}
std::string view_of_floor(const std::string& of_floor, int size = 16) {
  return camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, size) +
         flat("rectangle", scale("4, 4, 1"), of_floor);
}

/// A function of the scene, the settings and the samples of a pass; threads change nothing.
TEST(VcmPlanner, PlansTheSameAgain) {
  const TestScene scene(view_of_floor(diffuse("0.5, 0.5, 0.5")) + lamp_above() +
                        sphere("0.2, -0.05, 0.401", 0.4, glass()));
  for (const TypeInfo* type : {&auto_info(), &vcm_info()}) {
    SCOPED_TRACE(type->name);
    const VcmSettings settings = settings_of(*type);
    const FirstPlans first = all_planned(scene, settings);
    ASSERT_TRUE(first.plans->techniques.merging);
    const std::vector<uint8_t> bytes = bytes_of(*first.plans);
    for (const int threads : {1, 2, 5})
      with_threads(threads, [&] {
        const FirstPlans again = all_planned(scene, settings);
        EXPECT_TRUE(bytes_of(*again.plans) == bytes) << threads << " threads";
        EXPECT_EQ(again.rays, first.rays);
      });
    EXPECT_FALSE(bytes_of(planned(scene, settings, 8)) == bytes);
  }
}

void expect_no_light_paths(const VcmPlans& plans) {
  EXPECT_FALSE(plans.techniques.needs_light_paths());
  EXPECT_TRUE(plans.techniques.unidirectional && plans.techniques.next_event);
  EXPECT_EQ(plans.light_paths, 0);
  ASSERT_EQ(plans.decisions.size(), 1u);
  EXPECT_NE(plans.decisions[0].find("camera alone"), std::string::npos);
}
void expect_paths_alone(const VcmPlans& plans) {
  expect_no_light_paths(plans);
  for (const PixelPlan& plan : plans.pixels.plans()) EXPECT_EQ(plan.survival, 1);
}

/// Where nothing can merge, all camera paths go on, alone.
TEST(VcmPlanner, LeavesLightPathsOutWhereNothingMerges) {
  // Mirrors all around, a lamp, nothing else.
  const std::string mirrors = camera("0.2, -0.75, 0.1", "0, 1, 0.1", 60, 16) +
                              flat("cube", scale("3, 3, 3"), set("flip_normals", true) + mirror()) +
                              lamp_above();
  expect_paths_alone(planned(mirrors, auto_info()));
  const VcmPlans of_mirrors = planned(mirrors, ppm_info());
  for (const PixelPlan& plan : of_mirrors.pixels.plans()) EXPECT_EQ(plan.survival, 1);
  EXPECT_EQ(of_mirrors.light_paths, settings_of(ppm_info()).light_paths);
  // A black floor sends nothing on, however much light falls on it; and there may be no lamp.
  expect_paths_alone(planned(view_of_floor(diffuse("0, 0, 0")) + lamp_above(), auto_info()));
  expect_paths_alone(planned(view_of_floor(diffuse("0.5, 0.5, 0.5")), auto_info()));
}

/// Light that no camera path finds has to be merged, where it is wanted.
TEST(VcmPlanner, KeepsLightPathsForWhatNothingElseFinds) {
  const std::string bare = view_of_floor(diffuse("0.5, 0.5, 0.5")) + point_light("0, 0.1, 1.2", 3);
  const std::string covered = bare + sphere("0, 0.1, 1.2", 0.2, glass());
  const VcmPlans hidden = planned(covered, auto_info());
  EXPECT_TRUE(hidden.pilot->needs_merging);
  EXPECT_TRUE(hidden.techniques.merging);
  EXPECT_GT(hidden.light_paths, 0);
  const VcmPlans seen = planned(bare, auto_info());
  EXPECT_FALSE(seen.pilot->needs_merging);
  // Paths that go on find nothing there, so few do.
  expect_no_light_paths(seen);
  // Nor is light of a point hidden that comes by matt events.
  const std::string matt = sphere("0.5, 0.1, 0.4", 0.4, diffuse("0.5, 0.5, 0.5"));
  EXPECT_FALSE(planned(bare + matt, auto_info()).pilot->needs_merging);
  VcmSettings of_direct = settings_of(auto_info());
  of_direct.components = ComponentSet();
  of_direct.components.add(Component::direct);
  EXPECT_FALSE(planned(TestScene(covered), of_direct).pilot->needs_merging);
}

/// Where even a cache without noise and cost would not pay, none is tried; passes of a single
/// sample may have one.
TEST(VcmPlanner, TriesCachesWhereTheyMayPay) {
  const auto tried = [](const std::string& inside, uint32_t samples) {
    const VcmPlans plans = planned(TestScene(inside), settings_of(auto_info()), samples);
    EXPECT_TRUE(
        std::any_of(plans.pilot->probes.begin(), plans.pilot->probes.end(),
                    [](const ProbeStatistics& probe) { return probe.has_diffuse_indirect(); }));
    return plans.pilot->has_tried(1);
  };
  const std::string lit_directly = view_of_floor(diffuse("0.1, 0.1, 0.1")) + lamp_above() +
                                   sphere("0.5, 0.1, 0.4", 0.4, diffuse("0.1, 0.1, 0.1"));
  const std::string lit_by_walls = camera("0.2, -0.1, -0.3", "1, 0.3, 0.2", 80, 16) +
                                   sphere("0, 0, 0", 1, diffuse("0.8, 0.8, 0.8"), true) +
                                   sphere("-0.4, 0.3, 0.1", 0.2f, area_light("1, 1, 1"));
  for (const uint32_t samples : {1, 4}) {
    EXPECT_FALSE(tried(lit_directly, samples)) << samples;
    EXPECT_TRUE(tried(lit_by_walls, samples)) << samples;
  }
}

/// Costs of the pilot are those of a pass: rays of light paths over camera samples.
TEST(VcmPlanner, KnowsWhatAPassOfABallCosts) {
  const HollowBall ball;
  VcmSettings settings = settings_of(ppm_info());
  settings.light_paths = 8;
  settings.maximum_events = 2;
  settings.radius = 0.1f;
  settings.guiding = settings.edges = false;
  const VcmPlans plans = planned(ball.test_scene(), settings);
  const VcmPilot& pilot = *plans.pilot;
  EXPECT_EQ(pilot.light_paths, 8);
  EXPECT_EQ(pilot.costs.camera_samples, 4);
  // To the wall, and on from there, but for what roulette ends. The pilot has half of 18432 paths,
  // which tell it to 0.3 %.
  EXPECT_NEAR(pilot.costs.light_rays, 8 * (1 + HollowBall::albedo), 0.01 * 8 * 1.6);
  const double in_disk = 8 * 4 * sqr(double(HollowBall::pixels)) * double(pi) * 0.01 *
                         HollowBall::density() * HollowBall::albedo;
  double merged = 0;
  for (size_t i = 0; i < pilot.probes.size(); ++i) {
    merged += pilot.probes[i].merged / double(pilot.probes.size());
    EXPECT_EQ(pilot.areas[i], pi * sqr(0.1f));
  }
  EXPECT_NEAR(merged / in_disk, 1, 0.2);
  EXPECT_NEAR(plans.connectible_per_path, 1, 1e-6);  // nothing is connected
}

/// Plans that were made by a pilot of two probes.
VcmPlans two_probes() {
  VcmPilot pilot;
  ProbeStatistics probe;
  probe.rays = 2;
  probe.rays_beyond = 6;
  probe.radiance = 1;
  probe.squares[ProbeStatistics::bin_of_one + 6] = 1;
  probe.path_mean_square = probe.path_variance = 1;
  probe.direct_variance = probe.light_sample_variance = 1;
  probe.light_sample_rays = 1;
  pilot.probes = {probe, probe};
  pilot.areas = {0.5f, 0};  // the second found no surface
  pilot.costs = {4, 2};
  pilot.light_paths = 0.5f;
  VcmPlans plans;
  plans.techniques.merging = true;
  plans.light_paths = 2;
  plans.pilot = std::make_shared<const VcmPilot>(pilot);
  return plans;
}

TEST(VcmPlans, ScalesAreRelativeToThePilot) {
  VcmPlans plans = two_probes();
  const std::vector<PixelPlan> disks{{1.5f, 1, 1}, {3, 1, 1}};
  auto scales = plans.merge_scales(disks, 0.25f);
  ASSERT_EQ(scales.size(), 2u);
  EXPECT_DOUBLE_EQ(scales[0].area, 0.75);
  EXPECT_DOUBLE_EQ(scales[1].area, 1);
  EXPECT_DOUBLE_EQ(scales[0].light_paths, 4);
  EXPECT_DOUBLE_EQ(scales[1].light_paths, 4);
  plans.techniques.merging = false;
  scales = plans.merge_scales(disks, 1);
  EXPECT_DOUBLE_EQ(scales[0].light_paths, 0);
}

/// How a disk of that area, m², around the only probe of `plans` differs from the pilot's.
MergeScale scale_of(const VcmPlans& plans, double area) {
  const double width = double(plans.pixels.seen().probes()[0].pixel_width);
  const auto widths = float(std::sqrt(area / double(pi)) / width);
  const double in_common = double(noise_in_common(spread_of_disk(widths)));
  return {.area = area / 0.5, .light_paths = 4, .in_common = in_common};
}

/// Plans are chosen as choose_plans() does it for those scales.
TEST(VcmPlans, SettleByWhatIsChosen) {
  VcmPlans plans = two_probes();
  const TestScene scene(view_of_floor(diffuse("0.5, 0.5, 0.5"), 4));
  plans.pixels = PixelPlans(scene.scene());
  ASSERT_EQ(plans.pixels.plans().size(), 1u);
  VcmPilot one = *plans.pilot;
  one.probes.pop_back();
  one.areas.pop_back();
  plans.pilot = std::make_shared<const VcmPilot>(one);
  const std::vector<PixelPlan> disks{{.merge_area = 1.5f, .survival = 0.7f, .evenness = 3}};
  std::vector<PixelPlan> expected = disks;
  const Efficiency by_hand =
      choose_plans(one.probes, one.costs, {scale_of(plans, 0.25 * 1.5)}, {}, expected);
  const Efficiency settled = plans.settle(disks, 0.25f);
  EXPECT_EQ(settled.squared_error, by_hand.squared_error);
  EXPECT_EQ(settled.rays, by_hand.rays);
  EXPECT_LT(expected[0].survival, 1);
  EXPECT_EQ(plans.pixels.plans()[0].survival, expected[0].survival);
  EXPECT_EQ(plans.pixels.plans()[0].evenness, expected[0].evenness);
  EXPECT_GT(expected[0].light_samples, 1);
  EXPECT_EQ(plans.pixels.plans()[0].light_samples, expected[0].light_samples);
  EXPECT_EQ(plans.pixels.plans()[0].merge_area, 1.5f);

  plans.choices = {.light_samples = false};
  plans.settle(disks, 0.25f);
  EXPECT_EQ(plans.pixels.plans()[0].light_samples, 1);
  EXPECT_LT(plans.pixels.plans()[0].survival, 1);
  plans.choices = {.survival = false, .light_samples = false};
  const double of_all =
      2 + 6 + 3 * cost_model.merging + rays_beside_camera_paths(one.probes, one.costs, {{0.75, 4}});
  EXPECT_DOUBLE_EQ(plans.settle(disks, 0.25f).rays, of_all);
  EXPECT_EQ(plans.pixels.plans()[0].survival, 1);
}

/// Whether a cache pays is told by the typical probe, not by the few that have most of all error.
TEST(VcmPlans, FewLoudProbesDoNotHideThatACachePays) {
  const TestScene scene(view_of_floor(diffuse("0.5, 0.5, 0.5"), 64));
  VcmPlans plans = two_probes();
  plans.pixels = PixelPlans(scene.scene());
  const size_t count = plans.pixels.plans().size();
  ASSERT_GT(count, 200u);
  VcmPilot pilot = *plans.pilot;
  pilot.needs_merging = true;
  pilot.probes[0].direct_variance = pilot.probes[0].light_sample_variance = 0.01;
  pilot.probes.assign(count, pilot.probes[0]);
  pilot.areas.assign(count, pilot.areas[0]);
  pilot.cache_trials[0] = {.served = std::vector<uint8_t>(count, 1),
                           .ray_variance = std::vector<float>(count, 0.01f),
                           .light_variance = std::vector<float>(count, 0.0f),
                           .rays_per_ray = 0.1};
  const auto rounds = [&](size_t loud_ones) {
    VcmPilot with_loud = pilot;
    for (size_t i = 0; i < loud_ones; ++i) with_loud.probes[10 + i].direct_variance = 1e5;
    VcmPlans settled = plans;
    settled.pilot = std::make_shared<const VcmPilot>(with_loud);
    VcmPlans chosen = with_light_paths_that_pay(settled, {});
    settle_with_cache(settled);
    EXPECT_EQ(chosen.cache.rounds, settled.cache.rounds);
    return settled.cache.rounds;
  };
  EXPECT_EQ(rounds(0), 1);
  EXPECT_EQ(rounds(count / 100), 1);
  // More of them are the typical ones.
  EXPECT_EQ(rounds(count / 10), 0);
}

/// With a cache they are chosen by what it leaves, and by what it costs.
TEST(VcmPlans, SettleByWhatACacheLeaves) {
  VcmPlans plans = two_probes();
  const TestScene scene(view_of_floor(diffuse("0.5, 0.5, 0.5"), 4));
  plans.pixels = PixelPlans(scene.scene());
  VcmPilot one = *plans.pilot;
  one.probes.pop_back();
  one.areas.pop_back();
  one.probes[0].ungathered.squares[ProbeStatistics::bin_of_one] = 0.001;
  one.cache_trials[0] = {
      .served = {1}, .ray_variance = {2}, .light_variance = {3}, .rays_per_ray = 4 * 0.1};
  EXPECT_TRUE(one.has_tried(0) && one.has_tried(1));
  EXPECT_FALSE(one.has_tried(2));
  plans.pilot = std::make_shared<const VcmPilot>(one);
  plans.choices = {.survival = false, .light_samples = false};
  const std::vector<PixelPlan> disks{{1.5f, 1, 1}};
  const Efficiency without = plans.settle(disks, 0.25f);
  plans.cache = {.rounds = 1, .gather_rays = 100};
  const Efficiency with = plans.settle(disks, 0.25f);
  EXPECT_DOUBLE_EQ(with.rays, without.rays + 10 * cost_model.gather_ray);
  // 4 samples, of which all go on; 4 times the light paths merge in 3/4 of the area.
  const double relative = 1 / 1.01;
  const double nu = 0.75 * 4 / scale_of(plans, 0.25 * 1.5).in_common;
  const double direct = 1.0 / 4;
  EXPECT_NEAR(without.squared_error, (1 / (4 + 64 * nu) + direct) * relative, 1e-9);
  const double gathered = 2.0 / 100 + 3.0 / 4;
  EXPECT_NEAR(with.squared_error, (0.001 / (4 + nu) + direct + gathered) * relative, 1e-9);
  // One probe stands for all.
  const Efficiency expected = plans.expected(disks, 0.25f);
  EXPECT_EQ(expected.squared_error, with.squared_error);
  EXPECT_EQ(expected.rays, with.rays);
}

/// What the camera sees from 2 m off counts as near within one degree.
TEST(VcmPlans, AcceptedAreaGoesByTheDistance) {
  const TestScene scene(camera("0, 0, 2", "0, 0, 0", 1, 8, "0, 1, 0") +
                        flat("rectangle", "", diffuse("0.5, 0.5, 0.5")));
  const double degree = double(pi) / 180;
  EXPECT_NEAR(accepted_area(PixelPlans(scene.scene())), double(pi) * sqr(2 * std::tan(degree)),
              1e-5);
}

/// Merging at both probes, on average, and the light paths' part, by the rows of the cost model.
TEST(Efficiency, RaysBesideCameraPaths) {
  std::vector<ProbeStatistics> probes(2);
  probes[0].merged = 30;
  probes[1].merged = 10;
  probes[0].rays = 100;  // the path's own
  const PassCosts costs{4, 1.5};
  const double expected = cost_model.merging +
                          cost_model.merged_vertex * (30 * 2 * 3 + 10 * 0.5 * 3) / 2 +
                          cost_model.light_ray * 1.5 * 3;
  EXPECT_DOUBLE_EQ(rays_beside_camera_paths(probes, costs, {{2, 3}, {0.5, 3}}), expected);
  // Without light paths nothing merges.
  EXPECT_DOUBLE_EQ(rays_beside_camera_paths(probes, costs, {{2, 0}, {0.5, 0}}), 0);
  EXPECT_DOUBLE_EQ(rays_beside_camera_paths({}, costs, {}), 0);
  // They are what choose_plans() adds to the rays of the paths themselves.
  std::vector<PixelPlan> plans(2);
  EXPECT_DOUBLE_EQ(choose_plans(probes, costs, {{2, 3}, {0.5, 3}}, {}, plans).rays, expected + 50);
}

TEST(Efficiency, StatisticsAreAddedByWeight) {
  ProbeStatistics sum, other;
  other.squares[7] = 1;
  other.merged_alone = 2;
  other.path_mean_square = 3;
  other.path_variance = 4;
  other.direct_variance = 5;
  other.light_sample_variance = 10;
  other.light_sample_rays = 11;
  other.radiance = 6;
  other.merged = 7;
  other.rays = 8;
  other.rays_beyond = 9;
  other.glossy_squares[3] = 12;
  other.glossy_merged_alone = 13;
  other.glossy_rays_beyond = 14;
  other.single_direct_variance = 15;
  other.ungathered.glossy_squares[4] = 16;
  other.ungathered.glossy_merged_alone = 17;
  sum.add(other, 0.5);
  sum.add(other, 2);
  EXPECT_EQ(sum.squares[7], 2.5);
  EXPECT_EQ(sum.squares[6], 0);
  EXPECT_EQ(sum.merged_alone, 5);
  EXPECT_EQ(sum.path_mean_square, 7.5);
  EXPECT_EQ(sum.path_variance, 10);
  EXPECT_EQ(sum.direct_variance, 12.5);
  EXPECT_EQ(sum.light_sample_variance, 25);
  EXPECT_EQ(sum.light_sample_rays, 27.5);
  EXPECT_EQ(sum.radiance, 15);
  EXPECT_EQ(sum.merged, 17.5);
  EXPECT_EQ(sum.rays, 20);
  EXPECT_EQ(sum.rays_beyond, 22.5);
  EXPECT_EQ(sum.glossy_squares[3], 30);
  EXPECT_EQ(sum.glossy_merged_alone, 32.5);
  EXPECT_EQ(sum.glossy_rays_beyond, 35);
  EXPECT_EQ(sum.single_direct_variance, 37.5);
  EXPECT_EQ(sum.ungathered.glossy_squares[4], 40);
  EXPECT_EQ(sum.ungathered.glossy_merged_alone, 42.5);
  // With a cache, what it does not have is left of both lobes.
  EXPECT_EQ(sum.with_cache(64, 0).glossy_squares[3], 0);
  EXPECT_EQ(sum.with_cache(64, 0).glossy_squares[4], 40);
  EXPECT_EQ(sum.with_cache(64, 0).glossy_merged_alone, 42.5);
}

}  // namespace
}  // namespace kaustik
