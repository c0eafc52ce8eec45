// Camera paths step by step in a matt ball, where all that they find is known on paper: what they
// know of their vertices, and what each way of finding light adds.

#include "kaustik/vcm/camera_path/camera_path.h"

#include "tests/vcm/ball_camera_paths.h"

namespace kaustik {
namespace {

using namespace test;

bool goes_on(CameraPath& path) { return path.go_on(false) == CameraWalk::Arrival::surface; }
void expect_surface(CameraPath& path) { EXPECT_TRUE(goes_on(path)); }
/// By the cosine law.
void scatter(CameraPath& path, Sampler& sampler) {
  const Vec2f u = sampler.next_2d();
  EXPECT_TRUE(path.walk().scatter(Lobes::all, 1, sampler.next_1d(), u));
  path.leave();
}

/// Densities of the vertices, per area.
TEST(CameraPath, KnowsTheDensitiesOfItsVertices) {
  const HollowBall ball;
  BallCameraPaths paths(ball, merging_weights(100, 0.1f), {});
  paths.begin(100, 0, 5);
  const Camera& eye = ball.scene().camera();
  paths.for_samples([&](const Vec2f& raster, Sampler& sampler) {
    SampleSink sink(ComponentSet::all());
    CameraPath path(paths.inputs(), paths.plan(), raster, sampler, sink);
    EXPECT_TRUE(path.vertices().is_at_first());
    expect_surface(path);
    const Vec3f first = path.walk().vertex().position();
    // Pixels per area: what a small step along the wall is on the raster, in both directions.
    const Frame wall(normalize(first));
    constexpr float step = 1e-2f;
    const auto seen = [&](const Vec3f& off) {
      return eye.connect(normalize(first + off), Camera::middle_of_lens()).raster;
    };
    const Vec2f a = (seen(wall.x * step) - seen(wall.x * -step)) / (2 * step);
    const Vec2f b = (seen(wall.y * step) - seen(wall.y * -step)) / (2 * step);
    const float pixels_per_area = std::fabs(a.x * b.y - a.y * b.x);
    const float expected = pixels_per_area * BallCameraPaths::samples;
    EXPECT_NEAR(path.vertices().list()[0].pdf_camera, expected, 1e-2f * expected);

    scatter(path, sampler);
    EXPECT_TRUE(path.vertices().has_left_first());
    EXPECT_FALSE(path.vertices().is_at_first());
    expect_surface(path);
    const float distance = length(path.walk().vertex().position() - first);
    const auto density = float(HollowBall::density());
    EXPECT_NEAR(path.vertices().list()[1].pdf_camera, density, 1e-3f * density);
    // The cosine is half the distance at both ends of a chord.
    EXPECT_NEAR(path.vertices().list()[1].to_previous, 1 / (2 * distance), 1e-3f / distance);
    // Light from anywhere goes back to the first vertex with that density, too.
    scatter(path, sampler);
    EXPECT_FALSE(path.vertices().has_left_first());
    EXPECT_NEAR(path.vertices().list()[0].pdf_light, density, 1e-3f * density);
  });
}

/// A path's light by one event, and by two: merged at its first vertex, or found beyond.
struct BallParts {
  RunningStatistics direct, merged, beyond, bias, went_on, count, alone;
};
BallParts parts_of(const HollowBall& ball, uint32_t light_paths, float radius,
                   const PixelPlan& plan) {
  BallCameraPaths paths(ball, merging_weights(light_paths, radius), plan);
  BallParts result;
  constexpr uint32_t passes = slow_build ? 4 : 24;
  for (uint32_t number = 0; number < passes; ++number) {
    paths.begin(light_paths, number, 2);
    RunningStatistics direct, merged, beyond, bias, went_on, count, alone;
    paths.for_samples([&](const Vec2f& raster, Sampler& sampler) {
      SampleSink sink(ComponentSet::all());
      double before = 0;
      const auto added = [&] {
        const double now = light_in(sink), difference = now - before;
        before = now;
        return difference;
      };
      CameraPath path(paths.inputs(), plan, raster, sampler, sink);
      expect_surface(path);
      path.add_direct_light();
      direct.add(added());
      path.merge();
      merged.add(added());
      bias.add(double(sink.bias().sum()));
      double all = 0;
      const auto each = path.merged_vertices();
      for (const auto& vertex : each) all += double(vertex.light.sum());
      count.add(double(each.size()));
      alone.add(all);
      scatter(path, sampler);
      const bool survives = path.survives_first(sampler.next_1d());
      went_on.add(survives ? 1 : 0);
      if (survives) {
        expect_surface(path);
        path.add_direct_light();
      }
      beyond.add(added());
    });
    result.direct.add(direct.mean());
    result.merged.add(merged.mean());
    result.beyond.add(beyond.mean());
    result.bias.add(bias.mean());
    result.went_on.add(went_on.mean());
    result.count.add(count.mean());
    result.alone.add(alone.mean());
  }
  return result;
}

/// Light by two events is merged with the density n A / (4π S) of the paths of a pass, S samples of
/// a pixel sharing what they find, and found beyond with that of paths that go on, as the plan
/// counts them. The power heuristic shares it out by the squares.
TEST(CameraPath, SharesLightBetweenMergingAndGoingOn) {
  const HollowBall ball;
  constexpr uint32_t light_paths = 8000;
  const struct {
    float radius;
    PixelPlan plan;
  } rows[] = {{0.08f, {.merge_area = pi * sqr(0.08f)}},
              {0.08f, {.merge_area = pi * sqr(0.08f), .survival = 0.5f, .evenness = 4}},
              {0.06f, {.merge_area = pi * sqr(0.06f), .survival = 0.3f, .evenness = 1.5f}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(fmt::format("radius {}, survival {}, evenness {}", row.radius, row.plan.survival,
                             row.plan.evenness));
    const double in_disk =
        light_paths * double(row.plan.merge_area) * HollowBall::density();  // without roulette
    const double by_merging = sqr(in_disk / BallCameraPaths::samples);
    const double by_going_on = sqr(double(row.plan.survival * row.plan.evenness));
    const double share = by_merging / (by_merging + by_going_on);
    ASSERT_GT(share, 0.05);
    ASSERT_LT(share, 0.95);
    const BallParts parts = parts_of(ball, light_paths, row.radius, row.plan);
    const double light = HollowBall::radiance(2);
    EXPECT_NEAR(parts.direct.mean(), HollowBall::radiance(1), 1e-4 * HollowBall::radiance(1));
    expect_known_mean("merged", parts.merged, share * light, 0.06);
    expect_known_mean("found beyond", parts.beyond, (1 - share) * light, 0.06);
    expect_known_mean("went on", parts.went_on, double(row.plan.survival), 0.06);
    expect_known_mean("vertices in a disk", parts.count, in_disk * HollowBall::albedo, 0.05);
    expect_known_mean("merged without weights", parts.alone, light, 0.06);
    // Even light has no bias.
    EXPECT_GT(t_test_p_value(parts.bias, 0), analytic_level) << parts.bias.mean();
    EXPECT_LT(parts.bias.standard_error(), 0.05 * light);
  }
}

/// A path whose roulette has ended it still meets the lamp that comes next.
TEST(CameraPath, EndsAtALampAtMost) {
  const TestScene lit(camera("0, 0, 1", "0, 0, 0", 40, 4, "0, 1, 0") +
                      flat("rectangle", scale("9, 9, 1"), diffuse("0.5, 0.5, 0.5")) +
                      flat("rectangle",
                           scale("90, 90, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 2"),
                           diffuse("0.5, 0.5, 0.5") + area_light("1")));
  const LightPathEmission emission(lit.scene());
  const PathWeights weights = merging_weights(1, 0.1f);
  const LightVertices light;
  const MattMerging matt;
  const PixelPlans plans(lit.scene());
  const PixelPlan plan{.merge_area = 0.01f, .survival = 0.25f};
  const CameraPathInputs inputs{.scene = lit.scene(),
                                .emission = emission,
                                .weights = weights,
                                .light = light,
                                .matt = matt,
                                .seen = plans.seen()};
  std::array<double, 2> met{};
  for (const bool survives : {true, false}) {
    SCOPED_TRACE(survives);
    Sampler sampler = Sampler::at(1, 0, Stream::camera, 0, 0);
    SampleSink sink(ComponentSet::all());
    CameraPath path(inputs, plan, {2, 2}, sampler, sink);
    expect_surface(path);
    scatter(path, sampler);
    EXPECT_TRUE(path.vertices().has_roulette_at_first());
    EXPECT_TRUE(path.may_end_at_lamp());
    EXPECT_TRUE(path.survives_first(survives ? 0.2f : 0.3f));
    EXPECT_EQ(light_in(sink), 0);
    EXPECT_EQ(goes_on(path), survives);
    met[survives] = light_in(sink);
    if (survives) {
      EXPECT_NEAR(path.walk().throughput()[0], 0.5f / 0.25f, 1e-5f);
    }
  }
  // Of three lanes, beside sampling; those that go on count no more there.
  EXPECT_GT(met[0], 0);
  EXPECT_LT(met[0], 3 * 0.5);
  EXPECT_EQ(met[1], met[0]);
}

}  // namespace
}  // namespace kaustik
