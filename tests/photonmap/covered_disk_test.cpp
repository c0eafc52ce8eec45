// Which share of a disk of photons a surface covers: disks cut by a straight end, a corner, a wall,
// under glass, against their known shares.

#include "kaustik/photonmap/covered_disk.h"

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr float radius = 0.5f;
constexpr int samples = slow_build ? 1'000 : 10'000;

std::string rectangle(const std::string& transform, const std::string& bsdf = diffuse("0.5")) {
  return flat("rectangle", transform, bsdf);
}

/// The share of a cone of radius 1 that a straight line at distance d cuts off: 6 ∫ over r > d of r
/// (1 − r) acos(d/r)/π.
double share_beyond(double d) {
  constexpr int n = 20'000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double r = d + (1 - d) * (i + 0.5) / n;
    sum += 6 * r * (1 - r) * std::acos(d / r) / std::numbers::pi * (1 - d) / n;
  }
  return sum;
}

/// Mean estimates of one over the share, around the origin seen from above.
RunningStatistics inverse_shares(const std::string& inside, uint64_t& rays,
                                 Lobes keeping = Lobes::diffuse, float asked = 1) {
  const TestScene scene(camera("0, 0, 9", "0, 0, 0", 30, 4, "0, 1, 0") + inside);
  const Ray ray{{0, 0, 0.4f}, {0, 0, -1}, infinity};
  Hit hit;
  EXPECT_TRUE(scene.scene().intersect(ray, hit));
  SurfaceVertex vertex;
  vertex.meet(scene.scene(), ray, hit, TransportMode::radiance);
  EXPECT_NEAR(vertex.position().z, 0, 1e-6);
  const PhotonSurroundings around{scene.scene(), vertex, keeping};
  EstimateSettings kernel;
  kernel.kernel = Kernel::cone;
  RunningStatistics inverse;
  for (int i = 0; i < samples; ++i)
    inverse.add(double(inverse_covered_share(
        around, kernel, radius, asked, Sampler::at(1, 0, Stream::training, 0, uint32_t(i)), rays)));
  return inverse;
}
void expect_share(const std::string& what, const std::string& inside, double share,
                  float asked = 1) {
  uint64_t rays = 0;
  const RunningStatistics inverse = inverse_shares(inside, rays, Lobes::diffuse, asked);
  // As far as so many tries tell.
  const double expected = (1 - std::pow(1 - share, most_covering_tries)) / share;
  EXPECT_GT(t_test_p_value(inverse, expected), check_level()) << what << ": " << inverse.mean();
  // A whole disk would be told.
  EXPECT_LT(t_test_p_value(inverse, 1), check_level()) << what;
}

TEST(CoveredDisk, IsWhole) {
  uint64_t rays = 0;
  const RunningStatistics inverse = inverse_shares(rectangle(scale("5, 5, 1")), rays);
  EXPECT_EQ(inverse.mean(), 1);
  EXPECT_EQ(inverse.variance(), 0);
  EXPECT_EQ(rays, uint64_t(samples));
}

/// Where it is likely to be whole it is looked for seldom.
TEST(CoveredDisk, IsTheSameInTheMeanByFewLooks) {
  uint64_t rays = 0;
  EXPECT_EQ(inverse_shares(rectangle(scale("5, 5, 1")), rays, Lobes::diffuse, 0.125f).mean(), 1);
  EXPECT_LT(rays, uint64_t(samples) / 6);
  expect_share("few looks", rectangle(scale("5, 5, 1") + translate("-4.85, 0, 0")),
               1 - share_beyond(0.3), 0.125f);
}

TEST(CoveredDisk, EndsWithTheSurface) {
  for (const double d : {0.0, 0.3, 0.6})
    expect_share("straight",
                 rectangle(scale("5, 5, 1") + translate(fmt::format("{}, 0, 0", d * 0.5 - 5))),
                 1 - share_beyond(d));
  expect_share("corner", rectangle(scale("5, 5, 1") + translate("-5, -5, 0")), 0.25);
}

/// Photons of a lower step count too, as far as they lie within the radius: it must not be made up
/// for besides. What lies deeper is beyond the end.
TEST(CoveredDisk, TakesInSteps) {
  const auto step = [](double depth) {
    return rectangle(scale("5, 5, 1") + translate("-5, 0, 0")) +
           rectangle(scale("5, 5, 1") + translate(fmt::format("5, 0, {}", -depth)));
  };
  for (const double depth : {0.3, 0.6, 0.95}) {
    uint64_t rays = 0;
    EXPECT_EQ(inverse_shares(step(depth * double(radius)), rays).mean(), 1) << depth;
  }
  expect_share("deep", step(1.2 * double(radius)), 0.5);
}

/// Photons beyond a wall are not this side's, nor those below the floor.
TEST(CoveredDisk, EndsAtWalls) {
  const std::string wall =
      rectangle(scale("5, 5, 1") + rotate("0, 1, 0", 90) + translate("0.15, 0, 0"));
  expect_share("wall", rectangle(scale("5, 5, 1")) + wall, 1 - share_beyond(0.3));
}

TEST(CoveredDisk, EndsWhereOthersKeepNoPhotons) {
  expect_share("mirror",
               rectangle(scale("5, 5, 1") + translate("-5, 0, 0")) +
                   rectangle(scale("5, 5, 1") + translate("5, 0, 0"), mirror()),
               0.5);
}

TEST(CoveredDisk, IsSeenThroughGlass) {
  uint64_t rays = 0;
  const RunningStatistics inverse =
      inverse_shares(rectangle(scale("5, 5, 1")) + sphere("0.3, 0, 0.09", 0.08, glass()), rays);
  EXPECT_EQ(inverse.mean(), 1);
}

}  // namespace
}  // namespace kaustik
