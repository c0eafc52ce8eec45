// What the pilot tells of a matt ball, where all of it is known on paper.

#include "kaustik/vcm/plan/path_pilot.h"

#include <numeric>

#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

constexpr uint32_t ball_samples = 4;
constexpr uint32_t paths_of_ball_pass = 9000;
constexpr float pilot_radius = 0.15f;
/// Direct light, and light by one more event.
constexpr int pilot_events = 2;
constexpr uint32_t pilots = slow_build ? 6 : 48;

/// Vertices of a pass's light paths in a disk; of all there are, and of those that a camera path
/// would find as often, were there no roulette.
const double in_disk = paths_of_ball_pass * double(pi) * sqr(double(pilot_radius)) /
                       HollowBall::wall * HollowBall::mergeable(pilot_events);
/// m/p of all light by two events: what camera paths find with the density 1/wall, and light paths
/// without their roulette, merging by a kernel that is worth 3/4 of its vertices.
const double merged_ratio = 0.75 * in_disk / HollowBall::albedo;

struct BallPilot {
  std::vector<ProbeStatistics> probes;
  uint64_t rays = 0;
};

BallPilot pilot_of(const Scene& scene, const LightPathEmission& emission, const PixelPlans& plans,
                   const LightVertices& light, double share) {
  const PathWeights weights = merging_weights(paths_of_ball_pass, pilot_radius);
  const MattMerging no_matt;
  const CameraPathInputs inputs{.scene = scene,
                                .emission = emission,
                                .weights = weights,
                                .light = light,
                                .matt = no_matt,
                                .seen = plans.seen(),
                                .camera_samples = ball_samples,
                                .merge_radius_sq = sqr(pilot_radius),
                                .maximum_events = pilot_events};
  BallPilot result;
  result.probes = probe_statistics(inputs, plans, {.light_share = share}, result.rays);
  return result;
}

/// A pilot pass that has the fraction `share` of a pass's light paths.
BallPilot pilot_of(const HollowBall& ball, uint32_t number, double share) {
  const LightVertices light =
      ball.trace(merging_weights(paths_of_ball_pass, pilot_radius),
                 uint32_t(share * paths_of_ball_pass), number, pilot_events);
  PixelPlans plans(ball.scene());
  plans.choose_disks(light, paths_of_ball_pass, 30, pilot_radius);
  return pilot_of(ball.scene(), ball.emission(), plans, light, share);
}

double mean_of(const BallPilot& pilot, const std::function<double(const ProbeStatistics&)>& value) {
  double sum = 0;
  for (const ProbeStatistics& probe : pilot.probes) sum += value(probe);
  return sum / double(pilot.probes.size());
}

/// Light of one event is sampled without noise, and so is light of two by any path that goes on.
TEST(PathPilot, KnowsRaysAndNoiseOfABall) {
  const HollowBall ball;
  const BallPilot pilot = pilot_of(ball, 0, 1);
  // The balance heuristic, had camera paths 64 times as many as light that is merged.
  const double even =
      HollowBall::radiance(2) * 64 * ball_samples / (64 * ball_samples + merged_ratio);
  for (const ProbeStatistics& probe : pilot.probes) {
    // To the wall and to the lamp; to the wall, to the lamp, and where another lamp might be.
    EXPECT_NEAR(probe.rays, 2, 1e-9);
    EXPECT_NEAR(probe.rays_beyond, 3, 1e-9);
    EXPECT_NEAR(probe.direct_variance, 0, 1e-9);
    EXPECT_NEAR(probe.light_sample_variance, 0, 1e-9);
    EXPECT_NEAR(probe.light_sample_rays, 1, 1e-9);
    EXPECT_NEAR(probe.path_variance, 0, 1e-7);
    EXPECT_NEAR(probe.path_mean_square, sqr(even), 1e-3 * sqr(even));
    EXPECT_EQ(probe.merged_alone, 0);
    // All that is found beyond is diffuse indirect light, of which a cache leaves nothing.
    for (const double squares : probe.ungathered.squares) EXPECT_EQ(squares, 0);
    EXPECT_EQ(probe.ungathered.path_mean_square, 0);
    EXPECT_TRUE(probe.has_diffuse_indirect());
  }
  EXPECT_EQ(pilot.rays, pilot.probes.size() * 8 * 6);
}

/// Many times the pixels are hardly more work, and what is told stays the same.
TEST(PathPilot, TakesFewerPathsOfEachProbeOfALargePicture) {
  const auto paths_of = [](int side) {
    const BallPilot pilot = pilot_of(HollowBall(100, side), 0, 0.1);
    for (const ProbeStatistics& probe : pilot.probes) {
      EXPECT_NEAR(probe.rays, 2, 1e-9);
      EXPECT_NEAR(probe.rays_beyond, 3, 1e-9);
      EXPECT_NEAR(probe.direct_variance, 0, 1e-9);
    }
    return double(pilot.rays) / 6;
  };
  EXPECT_EQ(paths_of(256), 8 * 64 * 64);
  // Blocks of 6 × 6 pixels, then of 8 × 8.
  EXPECT_EQ(paths_of(612), 8 * 102 * 102);
  EXPECT_EQ(paths_of(1040), 7 * 130 * 130);
  // From some size on probes tell of those around: 250 blocks in a row, of which each second one.
  EXPECT_EQ(paths_of(2000), 8 * 125 * 125);
}

/// A lamp of which a screen hides half: a sample is about twice the light, or none, with a variance
/// of about the squared light.
TEST(PathPilot, KnowsTheNoiseOfLamps) {
  const TestScene half_hidden(
      camera("0, -4, 0.5", "0, 0, 0", 0.5, 64) +
      flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5")) +
      flat("rectangle", scale("0.2, 0.2, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 2"),
           diffuse("0, 0, 0") + area_light("1")) +
      flat("rectangle", scale("1, 1, 1") + translate("-1, 0, 1"), diffuse("0, 0, 0")));
  const PixelPlans plans(half_hidden.scene());
  const BallPilot pilot = pilot_of(half_hidden.scene(), LightPathEmission(half_hidden.scene()),
                                   plans, LightVertices(), 1);
  // Of the half that is seen, 0.08 m² at 2 m: by 0.5/π in three lanes.
  const double light = mean_of(pilot, [](const auto& probe) { return probe.radiance; });
  EXPECT_NEAR(light, 3 * 0.5 / std::numbers::pi * 0.08 / 4, 0.05 * light);
  const double lamp = mean_of(pilot, [](const auto& probe) { return probe.light_sample_variance; });
  EXPECT_NEAR(lamp / (light * light), 1, 0.1);
  const double direct = mean_of(pilot, [](const auto& probe) { return probe.direct_variance; });
  EXPECT_NEAR(direct / (light * light), 1, 0.2);
}

/// A board of fine stripes under a point of light: samples of a pixel differ by where it is looked
/// at, of which no further sample of the light tells anything.
TEST(PathPilot, NoiseOfTexturesIsNotThatOfLamps) {
  const TestScene stripes(
      camera("0, 0, 4", "0, 0, 0", 30, 64, "0, 1, 0") +
      flat("rectangle", scale("2, 2, 1"),
           R"(<bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
                <rgb name="color0" value="0.2"/><rgb name="color1" value="0.8"/>
                <transform name="to_uv"><scale x="200" y="200"/></transform></texture></bsdf>)") +
      point_light("0, 0, 3", 1));
  const PixelPlans plans(stripes.scene());
  const BallPilot pilot =
      pilot_of(stripes.scene(), LightPathEmission(stripes.scene()), plans, LightVertices(), 1);
  EXPECT_GT(mean_of(pilot, [](const auto& probe) { return probe.direct_variance; }), 0);
  for (const ProbeStatistics& probe : pilot.probes)
    ASSERT_LE(probe.light_sample_variance, 1e-6 * probe.direct_variance);
}

/// Blocks without paths of their own are told what is seen around them: half of the picture is a
/// wall, and half is nothing.
TEST(PathPilot, TellsWhatIsWhereInALargePicture) {
  const TestScene half(camera("0, -4, 0", "0, 0, 0", 30, 900) +
                       flat("rectangle",
                            scale("3, 3, 1") + rotate("1, 0, 0", 90) + translate("-3, 0, 0"),
                            diffuse("0.5, 0.5, 0.5")) +
                       point_light("-1, -3, 0", 1));
  const PixelPlans plans(half.scene());
  const BallPilot pilot =
      pilot_of(half.scene(), LightPathEmission(half.scene()), plans, LightVertices(), 1);
  const BlockGrid& grid = plans.seen().grid();
  ASSERT_EQ(pilot.probes.size(), grid.size());
  size_t of_wall = 0, of_nothing = 0;
  for (size_t i = 0; i < grid.size(); ++i) {
    constexpr int averaged = 6;  // blocks
    if (std::abs(2 * grid.block(i).x - grid.count().x) <= 2 * averaged) continue;
    const bool is_wall = plans.seen().probes()[i].found;
    ++(is_wall ? of_wall : of_nothing);
    ASSERT_NEAR(pilot.probes[i].rays, is_wall ? 2 : 1, 1e-9) << i;
  }
  EXPECT_GT(of_wall, grid.size() / 3);
  EXPECT_GT(of_nothing, grid.size() / 3);
}

/// However few of a pass's light paths the pilot has, it counts those of a pass.
TEST(PathPilot, CountsWhatMergesInABall) {
  const HollowBall ball;
  // 17 of 32 bins: 2⁵ is the nearest power of two to what merging finds over what paths find.
  const size_t bin = size_t(ProbeStatistics::bin_of_one) + 5;
  ASSERT_NEAR(std::log2(merged_ratio), 5.3, 0.1);
  const double light = HollowBall::radiance(2);
  for (const double share : {1.0, 0.25}) {
    SCOPED_TRACE(share);
    RunningStatistics merged, radiance, squares;
    double in_bin = 0;
    for (uint32_t i = 0; i < pilots; ++i) {
      const BallPilot pilot = pilot_of(ball, i, share);
      merged.add(mean_of(pilot, [](const auto& probe) { return probe.merged; }));
      radiance.add(mean_of(pilot, [](const auto& probe) { return probe.radiance; }));
      squares.add(mean_of(pilot, [](const auto& probe) {
        return std::accumulate(probe.squares.begin(), probe.squares.end(), 0.0);
      }));
      in_bin += mean_of(pilot, [&](const auto& probe) { return probe.squares[bin]; }) / pilots;
    }
    // Elsewhere is what comes at so small an angle that a disk off the wall sees it at another.
    EXPECT_GT(in_bin, 0.85 * squares.mean());
    expect_known_mean("vertices in a disk", merged, in_disk, 0.04);
    expect_known_mean("radiance", radiance, HollowBall::radiance(1) + light, 0.03);
    // ∫ f²/p, of which either way tells its share by the balance heuristic; light paths have
    // 1/albedo times as much, for those that are left carry that much more.
    const double expected = sqr(light) * (ball_samples + merged_ratio / HollowBall::albedo) /
                            (ball_samples + merged_ratio);
    expect_known_mean("squares", squares, expected, 0.1);
  }
}

}  // namespace
}  // namespace kaustik
