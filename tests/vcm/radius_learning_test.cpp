// Learned radii: wide where light is even, narrow at the edge of a shadow, and narrower the more is
// known.

#include "kaustik/vcm/lessons/radius_learning.h"

#include <mutex>
#include <random>

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A floor of 2 m seen from above, every pixel 1/32 m wide.
TestScene floor_scene() {
  return TestScene(camera("0, 0, 10", "0, 0, 0", 11.42, 64, "0, 1, 0") +
                   flat("rectangle", scale("3, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
                   point_light("0, 0, 5", 1));
}

/// Light from above on the floor, of density `density(x, y)` relative to the largest; what of that
/// is above `plain` came by specular events only.
template <typename Density>
LightVertices light_of(const Density& density, size_t count, unsigned seed, float plain = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1.5f, 1.5f), unit(0, 1);
  std::vector<Vec3f> positions;
  std::vector<LightVertexData> data;
  while (positions.size() < count) {
    const Vec3f at(place(random), place(random), 0);
    const float u = unit(random);
    if (u > density(at.x, at.y)) continue;
    LightVertexData vertex;
    vertex.specular = u > plain;
    vertex.flux = Spectrum(1, 1, 1, 0);
    vertex.direction = PackedDirection({0, 0, 1});
    vertex.side = CoarseNormal({0, 0, 1});
    positions.push_back(at);
    data.push_back(vertex);
  }
  LightVertices light;
  light.tree = {std::move(positions), std::move(data)};
  light.path_count = uint32_t(count);
  return light;
}

enum class Edges { found, not_looked_for };

/// Plans after `passes` of this light.
template <typename Density>
PixelPlans learned_radii(const Scene& scene, const Density& density, size_t count, uint32_t passes,
                         Edges edges = Edges::not_looked_for, unsigned seed = 0, float plain = 1) {
  PixelPlans first(scene);
  first.choose_disks(light_of(density, count, 99, plain), uint32_t(count), 20, 0);
  uint64_t rays = 0;
  if (edges == Edges::found) first.find_edges(scene, RadiusLearning::widest_widths(), 0, rays);
  const RadiusLearning learning(scene, first, rays);
  std::vector<RadiusLearning::Sums> sums(first.seen().probes().size());
  for (uint32_t pass = 0; pass < passes; ++pass) {
    const auto added = RadiusLearning::sums_of(first, light_of(density, count, seed + pass, plain),
                                               ComponentSet::all(), sums);
    for (size_t i = 0; i < sums.size(); ++i) sums[i].add(added[i]);
  }
  return first.with(learning.plans(first, sums, passes, 1));
}

double mean_radius(const PixelPlans& plans, int x0, int x1) {
  double sum = 0;
  int count = 0;
  for (int y = 8; y < 56; y += 4)
    for (int x = x0; x < x1; x += 4, ++count)
      sum += std::sqrt(double(plans.at({float(x) + 2, float(y) + 2}, 1).merge_area) /
                       std::numbers::pi);
  return sum / count;
}

TEST(RadiusLearning, WideInEvenLightAndNarrowAtAnEdge) {
  const TestScene scene = floor_scene();
  constexpr double pixel = 2.0 / 64, widest = pixel * 5.65;
  const auto even = [](float, float) { return 1.0f; };
  const auto edge = [](float x, float) { return x > 0 ? 1.0f : 0.1f; };
  // Some levels are lost by chance, since disks are compared at 1.5 standard errors.
  EXPECT_GT(mean_radius(learned_radii(scene.scene(), even, 3000, 4), 8, 56), 0.5 * widest);
  const PixelPlans few = learned_radii(scene.scene(), edge, 1500, 1);
  const PixelPlans many = learned_radii(scene.scene(), edge, 3000, 64);
  const double at_edge = mean_radius(many, 28, 36), beside = mean_radius(many, 8, 20);
  EXPECT_LT(at_edge, 0.6 * beside);
  EXPECT_LT(at_edge, mean_radius(few, 28, 36));
}

/// A line of focused light, a thirtieth of what the widest disk holds and nearly half of what the
/// narrowest does, is not blurred because all else is even.
TEST(RadiusLearning, NarrowAtALineOfFocusedLight) {
  const TestScene scene = floor_scene();
  constexpr float plain = 0.5f;
  const auto line = [](float x, float) { return std::fabs(x) < 0.02f ? 1.0f : plain; };
  const PixelPlans plans =
      learned_radii(scene.scene(), line, 3000, 64, Edges::not_looked_for, 0, plain);
  EXPECT_LT(mean_radius(plans, 28, 36), 0.6 * mean_radius(plans, 8, 20));
}

/// Beyond its end a surface has no light, which is no reason for small disks: what is there is
/// divided by what is covered.
TEST(RadiusLearning, EndsOfSurfacesAreNoEdgesOfLight) {
  const TestScene scene(camera("0, 0, 10", "0, 0, 0", 11.42, 64, "0, 1, 0") +
                        flat("rectangle", scale("0.5, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
                        point_light("0, 0, 5", 1));
  const auto even = [](float x, float) { return std::fabs(x) < 0.5f ? 1.0f : 0.0f; };
  const PixelPlans plans = learned_radii(scene.scene(), even, 3000, 4);
  // The end lies at pixels 16 and 48.
  EXPECT_GT(mean_radius(plans, 44, 48), 0.6 * mean_radius(plans, 28, 36));
}

/// A floor that a thin wall parts at pixel 48, as low as its top is thin.
TestScene floor_with_wall() {
  return TestScene(camera("0, 0, 10", "0, 0, 0", 11.42, 64, "0, 1, 0") +
                   flat("rectangle", scale("3, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
                   flat("rectangle",
                        scale("0.05, 3, 1") + rotate("0, 1, 0", -90) + translate("0.5, 0, 0.05"),
                        diffuse("0.5, 0.5, 0.5")) +
                   point_light("0, 0, 5", 1));
}

/// Mean over some seeds of the radii of the two blocks on either side of pixel 48. So few light
/// vertices that none of the disks has more than are worth their time.
template <typename Density>
RunningStatistics radii_there(const TestScene& scene, const Density& density,
                              Edges edges = Edges::found, int end = 56, size_t count = 1500) {
  RunningStatistics result;
  for (unsigned seed = 1; seed <= (slow_build ? 2 : 24); ++seed)
    result.add(
        mean_radius(learned_radii(scene.scene(), density, count, 8, edges, 1000 * seed), 40, end));
  return result;
}

/// Of radii that are to be alike, and of their standard error, relatively.
constexpr double tolerance = 0.1, largest_error = 0.05;

/// Disks that a wall cuts are as wide as others: their noise is known, which is that of fewer light
/// vertices with uneven factors, and neither even nor linear light looks different in half a disk.
TEST(RadiusLearning, DisksAtAWallAreAsWideAsOthers) {
  const TestScene open = floor_scene(), wall = floor_with_wall();
  const auto expect_alike = [&](const char* what, const auto& density) {
    const Comparison radii(radii_there(wall, density), radii_there(open, density));
    std::printf("  %s: %.4f m at a wall\n", what, radii.mean());
    if (!slow_build) expect_near_means(what, radii, tolerance, largest_error);
  };
  expect_alike("even light", [](float, float) { return 1.0f; });
  expect_alike("linear light", [](float x, float) { return 0.5f + 0.3f * x; });
}

/// The same of disks of which a part is covered, where no edges are known.
TEST(RadiusLearning, DisksThatAreHalfCoveredAreAsWideAsOthers) {
  const TestScene open = floor_scene(),
                  strip(camera("0, 0, 10", "0, 0, 0", 11.42, 64, "0, 1, 0") +
                        flat("rectangle", scale("2.5, 3, 1") + translate("-2, 0, 0"),
                             diffuse("0.5, 0.5, 0.5")) +
                        point_light("0, 0, 5", 1));
  const auto on_strip = [](float x, float) { return x < 0.5f ? 1.0f : 0.0f; };
  // As dense: 1000 of them in two thirds of what 1500 lie in.
  const Comparison radii(radii_there(strip, on_strip, Edges::not_looked_for, 48, 1000),
                         radii_there(
                             open, [](float, float) { return 1.0f; }, Edges::not_looked_for, 48));
  std::printf("  %.4f m at the end\n", radii.mean());
  if (!slow_build) expect_near_means("at the end of a strip", radii, tolerance, largest_error);
}

/// Disks that hold too many light vertices to be taken are not summed up again: plans stay.
TEST(RadiusLearning, LeavesOutHopelessDisks) {
  const TestScene scene = floor_scene();
  constexpr size_t dense = 150'000, sparse = 10'000;  // light vertices of a pass
  PixelPlans first(scene.scene());
  const auto even = [](float, float) { return 1.0f; };
  first.choose_disks(light_of(even, dense, 99), uint32_t(dense), 20, 0);
  uint64_t rays = 0;
  const RadiusLearning learning(scene.scene(), first, rays);
  const std::vector<RadiusLearning::Sums> none(first.seen().probes().size());
  const auto sums_after = [&](const auto& density, size_t count, bool narrows) {
    auto sums = none;
    for (uint32_t pass = 0; pass < 4; ++pass) {
      if (narrows && pass > 0) RadiusLearning::narrow(sums, pass);
      const auto added =
          RadiusLearning::sums_of(first, light_of(density, count, pass), ComponentSet::all(), sums);
      for (size_t i = 0; i < sums.size(); ++i) sums[i].add(added[i]);
    }
    return sums;
  };
  const auto whole = sums_after(even, dense, false), narrowed = sums_after(even, dense, true);
  const auto of_whole = learning.plans(first, whole, 4, 1);
  const auto of_narrowed = learning.plans(first, narrowed, 4, 1);
  constexpr size_t widest = RadiusLearning::level_count - 1;
  for (size_t p = 0; p < none.size(); ++p) {
    if (!first.seen().probes()[p].found) continue;
    ASSERT_LT(narrowed[p].levels, widest);
    EXPECT_EQ(narrowed[p].vertices[narrowed[p].levels - 1],
              whole[p].vertices[narrowed[p].levels - 1]);
    EXPECT_LT(narrowed[p].vertices[widest], whole[p].vertices[widest] / 3) << "of one pass, not 4";
    EXPECT_EQ(of_narrowed[p].merge_area, of_whole[p].merge_area);
  }
  for (const RadiusLearning::Sums& sums : sums_after(even, sparse, true))
    EXPECT_EQ(sums.levels, widest + 1);

  // Beside a step in density the sparse side keeps its disks, and plans are as without.
  const auto step = [](float x, float) { return x < 0 ? 1.0f : float(sparse) / float(dense); };
  constexpr size_t half_each = (dense + sparse) / 2;
  const auto whole_step = sums_after(step, half_each, false),
             narrowed_step = sums_after(step, half_each, true);
  const auto of_whole_step = learning.plans(first, whole_step, 4, 1);
  const auto of_narrowed_step = learning.plans(first, narrowed_step, 4, 1);
  constexpr double too_many = 600 * 4;  // vertices that no plan takes of four passes
  size_t narrower = 0, whole_disks = 0;
  for (size_t p = 0; p < none.size(); ++p) {
    if (!first.seen().probes()[p].found) continue;
    for (size_t level = narrowed_step[p].levels; level <= widest; ++level)
      EXPECT_GT(whole_step[p].vertices[level], too_many) << p << ' ' << level;
    ++(narrowed_step[p].levels <= widest ? narrower : whole_disks);
    EXPECT_EQ(of_narrowed_step[p].merge_area, of_whole_step[p].merge_area) << p;
  }
  EXPECT_GT(narrower, none.size() / 3);
  EXPECT_GT(whole_disks, none.size() / 4);
}

/// Of all blocks along an end of a surface at pixel 48, the inner side.
std::vector<PixelPlan> plans_at_end(const PixelPlans& plans) {
  std::vector<PixelPlan> result;
  for (int y = 8; y < 56; y += 4) result.push_back(plans.at({46, float(y) + 2}, 1));
  return result;
}

/// Slopes take off bias where light changes towards an edge, as soon as light paths can tell; where
/// it is even they would be noise alone, however many there are.
TEST(RadiusLearning, SlopesWhereTheyTakeOffBias) {
  const TestScene scene(camera("0, 0, 10", "0, 0, 0", 11.42, 64, "0, 1, 0") +
                        flat("rectangle", scale("0.5, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
                        point_light("0, 0, 5", 1));
  const auto even = [](float x, float) { return std::fabs(x) < 0.5f ? 1.0f : 0.0f; };
  const auto steep = [](float x, float) {
    return std::fabs(x) < 0.5f ? 0.5f + 0.5f * (x + 0.5f) : 0;
  };
  // Neighbouring blocks choose alike: of one seed all may.
  constexpr unsigned seeds = slow_build ? 12 : 16;
  const auto with_slopes = [&](const auto& density, size_t count, uint32_t passes) {
    double share = 0;
    for (unsigned seed = 1; seed <= seeds; ++seed)
      for (const PixelPlan& plan : plans_at_end(
               learned_radii(scene.scene(), density, count, passes, Edges::found, 1000 * seed)))
        share += plan.has_slopes / (12.0 * seeds);
    return share;
  };
  const double of_even = with_slopes(even, 1000, 16), of_few = with_slopes(steep, 200, 1),
               of_many = with_slopes(steep, 1000, 16);
  std::printf("  slopes in even light %.2f, in a slope that few paths show %.2f, and many %.2f\n",
              of_even, of_few, of_many);
  EXPECT_LT(of_even, 0.4);
  EXPECT_LT(of_few, of_many - 0.2);
  EXPECT_GT(of_many, 0.7);
}

/// Half of a disk at an end, as far as the radius reaches; all of it far from there.
TEST(RadiusLearning, TellsHowMuchIsCovered) {
  const TestScene scene(camera("0, 0, 10", "0, 0, 0", 11.42, 64, "0, 1, 0") +
                        flat("rectangle", scale("0.5, 3, 1"), diffuse("0.5, 0.5, 0.5")) +
                        point_light("0, 0, 5", 1));
  const auto even = [](float x, float) { return std::fabs(x) < 0.5f ? 1.0f : 0.0f; };
  for (const Edges edges : {Edges::found, Edges::not_looked_for}) {
    const PixelPlans plans = learned_radii(scene.scene(), even, 3000, 4, edges);
    for (const PixelPlan& plan : plans_at_end(plans)) {
      EXPECT_GT(plan.covered, 0.4f);
      EXPECT_LT(plan.covered, 1 - 0.1f * (plan.merge_radius() > 0.13f ? 1 : 0));
    }
    EXPECT_GT(plans.at({32, 32}, 1).covered, 0.99f);
  }
}

/// The pilot's light tells the radii of the first pass: in even light as wide as those of later
/// passes, where a number of neighbours alone is held to six pixels.
TEST(RadiusLearning, FirstPassHasThePilotsRadii) {
  const TestScene scene(camera("0, -0.8, 0", "0, 1, 0", 60, 256) +
                        sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) +
                        point_light("0, 0, 0", 1));
  Problems problems;
  const auto mean_widths = [&](bool learns) {
    VcmSettings settings(Arguments(ppm_info(), {}, {}, problems));
    settings.learn_radii = learns;
    const auto plain = std::make_shared<const LightPathEmission>(scene.scene());
    const VcmPlans plans = *VcmPlanner(scene.scene(), settings, plain).make(4, {}).plans;
    double widths = 0;
    for (size_t i = 0; i < plans.pixels.plans().size(); ++i)
      widths += double(plans.pixels.plans()[i].merge_radius() /
                       plans.pixels.seen().probes()[i].pixel_width);
    return widths / double(plans.pixels.plans().size());
  };
  EXPECT_LE(mean_widths(false), double(most_disk_widths) + 1e-3);
  EXPECT_GT(mean_widths(true), 1.2 * double(most_disk_widths));
}

TEST(RadiusLearning, RaysAreCountedAndStopRequestsSeen) {
  const TestScene scene = floor_scene();
  const auto even = [](float, float) { return 1.0f; };
  PixelPlans first(scene.scene());
  first.choose_disks(light_of(even, 3000, 99), 3000, 20, 0);
  uint64_t rays = 0;
  const RadiusLearning learning(scene.scene(), first, rays);
  // One ray upward, and two for each of eight points in ten rings.
  EXPECT_EQ(rays, first.seen().probes().size() * (1 + 2 * 8 * 10));
  std::stop_source source;
  source.request_stop();
  uint64_t rays_after_stop = 0;
  const RadiusLearning stopped(scene.scene(), first, rays_after_stop, source.get_token());
  EXPECT_EQ(rays_after_stop, 0u);
}

/// The rays of light passes, in this order.
uint64_t light_rays(const TestScene& scene, const Integrator& integrator, uint64_t seed,
                    uint32_t pass) {
  SplatBuffer splats(scene.scene().film(), integrator.traits().components);
  return integrator.prepare({seed, pass, 4}, splats, {}, {})->report.rays;
}

/// What disks cover is looked at before the first pass, and once for all seeds.
TEST(RadiusLearning, LooksOnce) {
  const TestScene scene = floor_scene();
  const auto learning = scene.integrator("ppm"),
             given = scene.integrator("ppm", set("radius", 0.1));
  const auto more_rays = [&](uint64_t seed, uint32_t pass) {
    return light_rays(scene, *learning, seed, pass) - light_rays(scene, *given, seed, pass);
  };
  EXPECT_GT(more_rays(1, 0), 0u);
  EXPECT_EQ(more_rays(1, 1), 0u);
  EXPECT_EQ(more_rays(1, 2), 0u);
  EXPECT_EQ(more_rays(2, 0), 0u);
  EXPECT_EQ(more_rays(2, 1), 0u);
}

/// Passes that were not rendered before are made up for: that is light traced, and told of.
TEST(RadiusLearning, MadeUpPassesAreCountedAndToldOf) {
  const TestScene scene = floor_scene();
  const auto learning = scene.integrator("vcm");
  SplatBuffer splats(scene.scene().film(), learning->traits().components);
  std::vector<double> told;
  std::mutex mutex;
  const auto state = learning->prepare({1, 4, 4}, splats, {}, [&](double share) {
    const std::lock_guard lock(mutex);
    told.push_back(share);
  });
  // Passes 0 to 3, then the pass itself.
  ASSERT_FALSE(told.empty());
  EXPECT_LE(told.front(), 0.2);
  EXPECT_DOUBLE_EQ(*std::max_element(told.begin(), told.end()), 1);
  EXPECT_GE(std::count_if(told.begin(), told.end(), [](double share) { return share <= 0.8; }), 4);
  SplatBuffer again(scene.scene().film(), learning->traits().components);
  const uint64_t of_one = learning->prepare({1, 4, 4}, again, {}, {})->report.rays;
  EXPECT_GT(state->report.rays, 3 * of_one);
}

}  // namespace
}  // namespace kaustik
