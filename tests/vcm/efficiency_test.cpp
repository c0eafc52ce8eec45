// How often camera paths go on, and how many lights they sample: by variances and costs, on paper,
// and the pilot's variances against those of pictures.

#include "kaustik/vcm/plan/efficiency.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/vcm/light_pass.h"
#include "kaustik/vcm/plan/cost_model.h"
#include "kaustik/vcm/plan/path_pilot.h"
#include "kaustik/vcm/plan/plans.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Light of 1 of which camera paths find all, merging a vertex of a pass for each 1/ratio of them.
ProbeStatistics light(int log2_ratio, double path_variance = 1) {
  ProbeStatistics probe;
  probe.squares[size_t(ProbeStatistics::bin_of_one + log2_ratio)] = 1;
  probe.path_mean_square = 1;
  probe.path_variance = path_variance;
  probe.radiance = 1;
  probe.rays = 2;
  probe.rays_beyond = 6;
  return probe;
}

struct Chosen {
  std::vector<PixelPlan> plans;
  Efficiency expected;
};
Chosen choose(const std::vector<ProbeStatistics>& probes, double light_paths = 1, double area = 1,
              double light_rays = 1) {
  Chosen result;
  result.plans.resize(probes.size());
  result.expected =
      choose_plans(probes, {4, light_rays},
                   std::vector<MergeScale>(probes.size(), {area, light_paths}), {}, result.plans);
  return result;
}

TEST(Efficiency, PathsGoOnWhereNothingElseFindsTheLight) {
  EXPECT_EQ(choose({light(-12)}).plans[0].survival, 1);
  EXPECT_EQ(choose({light(12)}).plans[0].survival, least_survival);
  // Each probe by itself.
  const Chosen both = choose({light(-12), light(12)});
  EXPECT_EQ(both.plans[0].survival, 1);
  EXPECT_EQ(both.plans[1].survival, least_survival);
  // Disks of 1/4096 of the area find as much less.
  EXPECT_EQ(choose({light(0)}, 1, 1.0 / 4096).plans[0].survival, 1);
}

/// Light that merging finds 4096 times as well: κ = 4 samples count 1 each, however even what they
/// find is, for plans say nothing of that; and ν is 4096.
TEST(Efficiency, ExpectedWhereAllGoOn) {
  const ProbeStatistics probe = light(12, 0.001);
  std::vector<PixelPlan> plans(1);
  const Efficiency expected = choose_plans({probe}, {4, 1}, {{1, 1}}, {.survival = false}, plans);
  EXPECT_EQ(plans[0].survival, 1);
  EXPECT_EQ(plans[0].evenness, 1);
  EXPECT_NEAR(expected.squared_error, 1 / (4 + 4096.0) / 1.01, 1e-12);
  // Merging at the vertex, and at the ends of every other one of the six rays beyond.
  EXPECT_NEAR(expected.rays, 2 + 6 + (1 + 3) * cost_model.merging + cost_model.light_ray, 1e-12);
  // No chance is better than the chosen one.
  EXPECT_LT(choose({probe}).expected.time(), expected.time());
}

/// A few probes with far more error than all others are not typical; light that is never found is.
TEST(Efficiency, AHundredthOfTheProbesIsNotTypical) {
  const ProbeStatistics common = light(0);
  ProbeStatistics loud = common;
  loud.direct_variance = 1e6;
  const auto expected = [&](size_t loud_ones, double light_paths = 1) {
    std::vector<ProbeStatistics> probes(1000, common);
    std::fill_n(probes.begin() + 100, loud_ones, loud);
    std::vector<PixelPlan> plans(probes.size());
    return choose_plans(probes, {4, 1}, std::vector<MergeScale>(probes.size(), {1, light_paths}),
                        {.survival = false, .light_samples = false}, plans);
  };
  const Efficiency quiet = expected(0);
  EXPECT_NEAR(quiet.typical_squared_error / quiet.squared_error, 1, 1e-9);
  EXPECT_NEAR(quiet.typical_time() / quiet.time(), 1, 1e-9);
  const Efficiency few = expected(10);
  EXPECT_NEAR(few.squared_error, 0.01 * 1e6 / 4 / 1.01, 1);
  EXPECT_NEAR(few.typical_squared_error / quiet.squared_error, 1, 1e-9);
  EXPECT_DOUBLE_EQ(few.rays, quiet.rays);
  const Efficiency many = expected(11);
  EXPECT_NEAR(many.typical_squared_error / many.squared_error, 1, 1e-9);

  std::vector<ProbeStatistics> hidden(1000, common);
  hidden[500].merged_alone = 1;
  std::vector<PixelPlan> plans(hidden.size());
  const auto no_light_paths = std::vector<MergeScale>(hidden.size(), {1, 0});
  EXPECT_TRUE(
      std::isinf(choose_plans(hidden, {4, 1}, no_light_paths, {}, plans).typical_squared_error));
}

/// With 4 samples, all of which go on, and no light paths the error is the variance of 4 samples.
TEST(Efficiency, VarianceOfPathsAlone) {
  ProbeStatistics probe = light(-12, 0.25);
  probe.direct_variance = 0.5;
  const Chosen chosen = choose({probe}, 0);
  ASSERT_EQ(chosen.plans[0].survival, 1);
  EXPECT_NEAR(chosen.plans[0].evenness, 4, 1e-6);
  // Relative to light of 1, and a tenth of the picture's mean.
  EXPECT_NEAR(chosen.expected.squared_error, (0.5 + 0.25) / 4 / 1.01, 1e-4);
  EXPECT_NEAR(chosen.expected.rays, 8, 1e-9);
}

/// Light that camera paths find best by the glossy lobe, and merging by the diffuse one: each goes
/// on as often as it pays for itself.
TEST(Efficiency, EachLobeHasItsChance) {
  ProbeStatistics probe = light(12);
  probe.glossy_squares = light(-12).squares;
  probe.glossy_rays_beyond = probe.rays_beyond;
  const PixelPlan plan = choose({probe}).plans[0];
  EXPECT_EQ(plan.survival, least_survival);
  EXPECT_EQ(plan.glossy_survival, 1);
  std::swap(probe.squares, probe.glossy_squares);
  const PixelPlan swapped = choose({probe}).plans[0];
  EXPECT_EQ(swapped.survival, 1);
  EXPECT_EQ(swapped.glossy_survival, 0.5f);  // no glossy lobe has less
  // All that glossy paths find, and what they cost, is expected as well.
  ProbeStatistics glossy = light(-12);
  std::swap(glossy.squares, glossy.glossy_squares);
  std::swap(glossy.rays_beyond, glossy.glossy_rays_beyond);
  EXPECT_NEAR(choose({glossy}).expected.rays, choose({light(-12)}).expected.rays, 1e-9);
  EXPECT_NEAR(choose({glossy}).expected.squared_error, choose({light(-12)}).expected.squared_error,
              1e-9);
}

/// What samples of a pass take off by stratifying one another lights' samples have less of to take.
TEST(Efficiency, StratifiedSamplesLeaveLessToLights) {
  ProbeStatistics probe;
  probe.radiance = 1;
  probe.rays = 2;
  probe.light_sample_rays = 1;
  probe.direct_variance = 0.5;
  probe.single_direct_variance = 1;
  probe.light_sample_variance = 0.8;
  const Efficiency expected = choose({probe}, 0).expected;
  const int lights = choose({probe}, 0).plans[0].light_samples;
  EXPECT_NEAR(expected.squared_error, (0.1 + 0.4 / lights) / 4 / 1.01, 1e-9);
}

/// A probe with nothing but direct light of variance 1, of which samples of lights share a part.
ProbeStatistics direct_light(double light_sample_variance, double light_sample_rays = 1) {
  ProbeStatistics probe;
  probe.direct_variance = 1;
  probe.light_sample_variance = light_sample_variance;
  probe.radiance = 1;
  probe.rays = 2;
  probe.light_sample_rays = light_sample_rays;
  return probe;
}

/// A sample of a light costs c rays more, cost_model.light_sample, and takes off its part of the
/// variance: with n of them the time is (1 − v + v/n)(2 + c (n − 1)).
TEST(Efficiency, AsManyLightsAreSampledAsPay) {
  const auto chosen = [&](const ProbeStatistics& probe) {
    return choose({probe}, 0).plans[0].light_samples;
  };
  EXPECT_EQ(chosen(direct_light(0)), 1);
  EXPECT_EQ(chosen(direct_light(0.3)), 1);
  EXPECT_EQ(chosen(direct_light(1)), 16);
  EXPECT_EQ(chosen(direct_light(1, 0)), 16);
  // Least near the root of (11 − c)/c · v/(1 − v).
  ProbeStatistics costly = direct_light(0.8);
  costly.rays = 11;
  EXPECT_EQ(chosen(costly), 8);
  costly.light_sample_variance = 0.3;
  EXPECT_EQ(chosen(costly), 2);
  const Efficiency expected = choose({costly}, 0).expected;
  EXPECT_NEAR(expected.squared_error, (0.7 + 0.3 / 2) / 4 / 1.01, 1e-6);
  EXPECT_NEAR(expected.rays, 11 + cost_model.light_sample, 1e-9);
  // Or one, if it is not asked for.
  std::vector<PixelPlan> plans(1);
  choose_plans({costly}, {4, 1}, {{1, 0}}, {.light_samples = false}, plans);
  EXPECT_EQ(plans[0].light_samples, 1);
}

/// Of light that merging alone finds, the variance falls with the number of light paths.
TEST(Efficiency, LightThatNoCameraPathFinds) {
  ProbeStatistics probe;
  probe.merged_alone = 0.1;
  probe.radiance = 1;
  probe.rays = 2;
  EXPECT_TRUE(std::isinf(choose({probe}, 0).expected.squared_error));
  EXPECT_NEAR(choose({probe}, 1).expected.squared_error, 0.1 / 1.01, 1e-6);
  EXPECT_NEAR(choose({probe}, 4).expected.squared_error, 0.025 / 1.01, 1e-6);
  EXPECT_GT(choose({probe}, 4).expected.rays, choose({probe}, 1).expected.rays + 3);
}

/// Both ways together are better than each alone, by the sum of their densities.
TEST(Efficiency, MixtureOfBothWays) {
  const double expected = choose({light(2)}).expected.squared_error;
  const double kappa = 4 * double(choose({light(2)}).plans[0].survival);
  EXPECT_NEAR(expected, 1 / (kappa + 4) / 1.01, 1e-6);
}

/// The error that a pilot expects of path tracing is that of path tracing.
TEST(PathPilot, ExpectsTheVarianceOfPathTracing) {
  const std::string grey = diffuse("0.6, 0.6, 0.6");
  const TestScene test(
      camera("0, -0.9, 1", "0, 1, 0.8", 70, 32) + flat("rectangle", "", grey) +
      flat("rectangle", rotate("1, 0, 0", 180) + translate("0, 0, 2"), grey) +
      flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"), grey) +
      flat("rectangle", rotate("0, 1, 0", 90) + translate("-1, 0, 1"), grey) +
      flat("rectangle", scale("0.3, 0.3, 1") + rotate("1, 0, 0", 180) + translate("0, 0.2, 1.9"),
           diffuse("0, 0, 0") + area_light("5")));
  const Scene& scene = test.scene();
  const LightPathEmission emission(scene);
  PathWeights::Settings settings;
  settings.techniques.merging = true;
  settings.light_paths = 4096;
  const PathWeights weights(settings);
  SplatBuffer nowhere = SplatBuffer::nowhere();
  PassReport report;
  const LightVertices vertices =
      trace_light_vertices({.scene = scene,
                            .emission = emission,
                            .weights = weights,
                            .light_paths = 4096,
                            .plans = PixelPlans()},
                           Pass{}, Stream::training, nowhere, {}, {}, report);
  PixelPlans plans(scene);
  plans.choose_disks(vertices, 4096, 30, 0);
  const MattMerging no_matt;
  const CameraPathInputs inputs{.scene = scene,
                                .emission = emission,
                                .weights = weights,
                                .light = vertices,
                                .matt = no_matt,
                                .seen = plans.seen()};
  uint64_t rays = 0;
  auto probes = probe_statistics(inputs, plans, {}, rays);
  for (ProbeStatistics& probe : probes) probe.rays_beyond = 0;  // so that all go on
  std::vector<PixelPlan> pixels = plans.plans();
  const Efficiency expected =
      choose_plans(probes, {1, 0}, std::vector<MergeScale>(probes.size(), {1, 0}),
                   {.light_samples = false}, pixels);

  // Of the pixels that the probes look at, in as many passes of one sample.
  const Passes passes = render(test, "path", "", {1, 3, 512});
  double mean = 0, error = 0;
  std::vector<RunningStatistics> values(probes.size());
  for (const Image& image : passes.images())
    for (size_t p = 0; p < probes.size(); ++p) {
      const Vec2f at = plans.seen().probes()[p].raster;
      double sum = 0;
      for (int c = 0; c < 3; ++c) sum += double(image.at(int(at.x), int(at.y), c));
      values[p].add(sum);
    }
  for (const RunningStatistics& v : values) mean += v.mean() / double(values.size());
  for (const RunningStatistics& v : values)
    error += v.variance() / (v.mean() * v.mean() + 0.01 * mean * mean) / double(values.size());
  EXPECT_EQ(pixels[0].survival, 1);
  // The pilot has 8 paths for every 16 pixels; factors like 2, π or the number of lanes would show.
  EXPECT_NEAR(expected.squared_error / error, 1, 0.35)
      << expected.squared_error << " expected, " << error << " measured";
  double radiance = 0;
  for (const ProbeStatistics& p : probes) radiance += p.radiance / double(probes.size());
  EXPECT_NEAR(radiance / mean, 1, 0.1);
}

/// Matt from within, without an edge that would make the samples of a pixel differ.
std::string hollow() {
  return camera("0.2, -0.6, 0.1", "0, 1, 0.1", 50, 24) +
         sphere("0, 0, 0", 1, diffuse("0.6, 0.6, 0.6"), true) + point_light("0.4, 0.1, 0.3", 1);
}

constexpr uint32_t samples_of_pass = 4;
constexpr float light_paths = 4;       // per camera sample
constexpr float merge_radius = 0.15f;  // some pixels wide

/// What ppm expects of a pass, by a pilot with `light_share` of its light paths.
struct Forecast {
  double squared_error = 0, radiance = 0;
  std::vector<PixelPlan> plans;
};
Forecast forecast(const Scene& scene, const Techniques& techniques, double light_share) {
  const LightPathEmission emission(scene);
  PixelPlans plans(scene);
  const uint32_t of_pass = light_path_count(scene.film().crop_size, samples_of_pass, light_paths);
  PathWeights::Settings settings;
  settings.techniques = techniques;
  settings.light_paths = float(of_pass);
  settings.merge_area = pi * sqr(merge_radius);
  settings.accepted_area = accepted_area(plans);
  const PathWeights weights(settings);
  SplatBuffer nowhere = SplatBuffer::nowhere();
  PassReport report;
  const LightVertices vertices =
      trace_light_vertices({.scene = scene,
                            .emission = emission,
                            .weights = weights,
                            .light_paths = uint32_t(light_share * of_pass),
                            .plans = PixelPlans()},
                           Pass{}, Stream::training, nowhere, {}, {}, report);
  plans.choose_disks(vertices, of_pass, 30, merge_radius);
  const MattMerging no_matt;
  const CameraPathInputs inputs{.scene = scene,
                                .emission = emission,
                                .weights = weights,
                                .light = vertices,
                                .matt = no_matt,
                                .seen = plans.seen(),
                                .camera_samples = samples_of_pass,
                                .merge_radius_sq = sqr(merge_radius)};
  PilotLimits limits;
  limits.light_share = light_share;
  uint64_t rays = 0;
  const auto probes = probe_statistics(inputs, plans, limits, rays);
  const double camera_samples = double(of_pass) / double(light_paths);
  Forecast result;
  result.plans = plans.plans();
  std::vector<MergeScale> scales;
  for (const PixelProbe& probe : plans.seen().probes())
    scales.push_back(
        {.in_common = double(noise_in_common(spread_of_disk(merge_radius / probe.pixel_width)))});
  result.squared_error =
      choose_plans(probes, {samples_of_pass, double(report.rays) / light_share / camera_samples},
                   scales, {}, result.plans)
          .squared_error;
  for (const ProbeStatistics& p : probes) result.radiance += p.radiance / double(probes.size());
  return result;
}

/// Of every square of so many pixels on a side the variance of its mean, where the values are those
/// of pictures of `width` pixels in a row; their mean.
double variance_of_squares(const std::vector<std::vector<double>>& pictures, int width, int side) {
  const int count = width / side;
  double sum = 0;
  for (int block_y = 0; block_y < count; ++block_y)
    for (int block_x = 0; block_x < count; ++block_x) {
      RunningStatistics mean;
      for (const std::vector<double>& picture : pictures) {
        double light = 0;
        for (int y = block_y * side; y < (block_y + 1) * side; ++y)
          for (int x = block_x * side; x < (block_x + 1) * side; ++x)
            light += picture[size_t(y * width + x)];
        mean.add(light / sqr(side));
      }
      sum += mean.variance();
    }
  return sum / sqr(count);
}

/// The same of pictures. All are first passes, whose disks have not shrunk, of as many seeds.
/// Errors are those that filters of 1, 3 and 9 pixels leave, as noise_in_common() counts them.
Forecast measured(const TestScene& test, const Integrator& integrator) {
  constexpr uint64_t seeds = slow_build ? 12 : 64;
  const int width = test.scene().film().crop_size.x;
  std::vector<std::vector<double>> pictures;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    SessionSettings settings;
    settings.seed = seed;
    settings.passes = 1;
    settings.samples_per_pass = samples_of_pass;
    Session session(test.scene(), integrator, settings);
    session.run();
    const Image image = session.film().image();
    std::vector<double>& values = pictures.emplace_back();
    for (size_t i = 0; i < image.pixel_count(); ++i)
      values.push_back(double(image.channel(0)[i]) + double(image.channel(1)[i]) +
                       double(image.channel(2)[i]));
  }
  Forecast result;
  std::vector<double> means(pictures[0].size());
  for (const std::vector<double>& picture : pictures)
    for (size_t i = 0; i < means.size(); ++i) means[i] += picture[i] / double(seeds);
  for (const double mean : means) result.radiance += mean / double(means.size());
  for (std::vector<double>& picture : pictures)
    for (size_t i = 0; i < means.size(); ++i)
      picture[i] /= std::sqrt(sqr(means[i]) + 0.01 * sqr(result.radiance));
  for (const int side : {1, 3, 9})
    result.squared_error += variance_of_squares(pictures, width, side) / (1 + 1 / 9.0 + 1 / 81.0);
  return result;
}

/// The error that a pilot expects of merging beside paths most of which go on, and of merging
/// alone, is that of passes of ppm. Four light paths per camera sample make merging's share in it
/// the larger.
TEST(PathPilot, ExpectsTheVarianceOfMergingLong) {
  const TestScene test(hollow());
  for (const bool next_event : {true, false}) {
    SCOPED_TRACE(next_event ? "both ways" : "merging alone");
    const auto ppm =
        test.integrator("ppm", set("guiding", false) + set("radius", double(merge_radius)) +
                                   set("light_paths", double(light_paths)) +
                                   set("next_event", next_event) + set("indirect_cache", "never"));
    const Forecast found = measured(test, *ppm);
    for (const double light_share : {1.0, 0.25}) {
      SCOPED_TRACE(light_share);
      const Forecast expected =
          forecast(test.scene(), {true, next_event, false, false, true}, light_share);
      // A lamp that is a point is met by none of them.
      const auto goes_on = [](const PixelPlan& plan) { return plan.survival == 1; };
      const auto ends = [](const PixelPlan& plan) { return plan.survival == least_survival; };
      const std::vector<PixelPlan>& plans = expected.plans;
      if (next_event)
        EXPECT_GT(4 * size_t(std::count_if(plans.begin(), plans.end(), goes_on)), 3 * plans.size());
      else
        EXPECT_TRUE(std::all_of(plans.begin(), plans.end(), ends));
      // A picture knows its error to 2 %, a pilot expects it to 4 %. What is within a third is not
      // when it is doubled or halved.
      EXPECT_NEAR(expected.squared_error / found.squared_error, 1, 1.0 / 3);
      EXPECT_NEAR(expected.radiance / found.radiance, 1, 0.15);
    }
  }
}

/// A lamp that a screen hides in part, over a floor, and nothing else: where several lights are
/// sampled, pictures gain what the pilot expects, or more, since the samples stratify one another.
TEST(PathPilot, ExpectsWhatSamplesOfLightsTakeOff) {
  const TestScene test(
      camera("0, -1, 3", "0, 0, 0", 20, 24) +
      flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5")) +
      flat("rectangle", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 2"),
           diffuse("0, 0, 0") + area_light("1")) +
      flat("rectangle", scale("0.5, 2, 1") + translate("-0.5, 0, 1"), diffuse("0, 0, 0")));
  Problems problems;
  const VcmSettings settings(Arguments(ppm_info(), {}, {}, problems));
  const auto plain = std::make_shared<const LightPathEmission>(test.scene(), settings.aim);
  VcmPlans plans = *VcmPlanner(test.scene(), settings, plain).make(samples_of_pass, {}).plans;
  const auto expected = [&](bool several) {
    plans.choices.light_samples = several;
    return plans.settle(plans.pixels.plans(), 1).squared_error;
  };
  const double of_several = expected(true);
  double count = 0;
  for (const PixelPlan& plan : plans.pixels.plans()) count += plan.light_samples;
  EXPECT_GT(count, 2 * double(plans.pixels.plans().size()));
  const double of_one = expected(false);
  EXPECT_LT(of_several, 0.6 * of_one);
  const auto error = [&](bool several) {
    return measured(test, *test.integrator("ppm", set("choose_light_samples", several)))
        .squared_error;
  };
  const double found_of_one = error(false);
  EXPECT_LT(found_of_one, 1.2 * of_one);
  EXPECT_LT(error(true) / found_of_one, 1.2 * of_several / of_one);
}

}  // namespace
}  // namespace kaustik
