#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "kaustik/photon/emission/aim_spheres.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using test::Random;
using test::scene_of;
using test::target_sets;
using test::Targets;

TEST(FindTargets, HoldEverySurfaceWithTheLobes) {
  for (const Targets& targets : target_sets()) {
    const auto scene = scene_of("point", targets);
    for (const int budget : {1, 5, 128}) {
      const std::vector<AimTarget> boxes = find_targets(*scene, Lobes::specular, budget);
      EXPECT_LE(boxes.size(), size_t(budget));
      Random random(2);
      for (int i = 0; i < 2000; ++i) {
        const Shape& shape = scene->tracer().shape(uint32_t(i) % uint32_t(scene->surface_count()));
        const Vec3f p = shape.sample_area(random.pair()).point.position;
        EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const AimTarget& t) {
          const float radius = t.radius > 0 ? t.radius : infinity;
          const Vec3f rounding = Vec3f(1, 1, 1) * 1e-6f;
          const Bounds3f box(t.box.min - rounding, t.box.max + rounding);
          return box.intersects(p) && length(p - center(t.box)) <= radius;
        })) << targets.name;
      }
    }
  }
}

TEST(FindTargets, LongThinShapesGetManyBoxes) {
  const auto scene = scene_of("point", target_sets()[1]);
  const std::vector<AimTarget> boxes = find_targets(*scene, Lobes::specular, 64);
  EXPECT_GT(boxes.size(), 30u);
  // A sphere is best held by one.
  const auto ball = scene_of("point", target_sets()[0]);
  const std::vector<AimTarget> one = find_targets(*ball, Lobes::specular, 64);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(one[0].radius, 0.4f, 0.001f);
  EXPECT_GT(one[0].weight, 0.5f);
}

TEST(MergeTargets, KeepsAllAndDropsEmptyOnes) {
  Random random(4);
  std::vector<AimTarget> targets(3);
  targets[1] = {Bounds3f(Vec3f(0, 0, 0), Vec3f(1, 1, 1)), 0.0f};
  targets[2] = {Bounds3f(Vec3f(0, 0, 0)), 1.0f};
  EXPECT_EQ(merge_targets(targets, 10).size(), 1u);
  for (int i = 0; i < 500; ++i) {
    const Vec3f at(random.number(), random.number(), random.number());
    targets.push_back({Bounds3f(at, at + Vec3f(0.01f, 0.02f, 0.01f)), 0.5f});
  }
  targets.insert(targets.end(), 200, targets.back());
  const std::vector<AimTarget> merged = merge_targets(targets, 64);
  EXPECT_EQ(merged.size(), 64u);
  for (size_t i = 2; i < targets.size(); ++i)
    EXPECT_TRUE(std::any_of(merged.begin(), merged.end(), [&](const AimTarget& m) {
      Bounds3f both = m.box;
      both.extendBy(targets[i].box);
      return both == m.box && m.weight > 0.49f;
    }));
}

TEST(SharePhotons, SumToTheTotal) {
  const std::vector<double> arriving = {1, 5, 0, 2.5}, power = {3, 1, 1, 7};
  for (const uint32_t total : {4u, 5u, 17u, 1000u, 1'000'003u, 4'000'000'000u}) {
    const std::vector<uint32_t> counts = share_photons(total, arriving, power);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), uint64_t(0)), total);
    for (const uint32_t count : counts) EXPECT_GE(count, 1u);
  }
}

TEST(SharePhotons, ManyLightsElsewhereDoNotStarveOne) {
  std::vector<double> arriving(51, 0.0), power(51, 100.0);
  arriving[17] = 0.01;
  power[17] = 1;
  const std::vector<uint32_t> counts = share_photons(100'000, arriving, power);
  EXPECT_GE(counts[17], 89'900u);
  for (const uint32_t count : counts) EXPECT_GE(count, 1u);
}

TEST(SharePhotons, FollowWhatArrives) {
  const std::vector<uint32_t> counts = share_photons(1'000'000, {1, 3}, {1, 1});
  EXPECT_NEAR(counts[1], 0.9 * 750'000 + 50'000, 2);
}

TEST(SharePhotons, OddInput) {
  EXPECT_TRUE(share_photons(10, {}, {}).empty());
  // Nothing arrived: by power. Lights without power get nothing.
  const std::vector<uint32_t> untrained = share_photons(10'000, {0, 0, 0}, {3, 1, 0});
  EXPECT_NEAR(untrained[0], 7475, 5);
  EXPECT_EQ(untrained[2], 0u);
  EXPECT_EQ(share_photons(100, {1}, {0}), std::vector<uint32_t>{0});
  // Fewer photons than lights: one each.
  EXPECT_EQ(share_photons(1, {1, 1}, {1, 1}), (std::vector<uint32_t>{1, 1}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(share_photons(100, {nan, 1}, {1, 1})[0] + share_photons(100, {nan, 1}, {1, 1})[1],
            100u);
}

}  // namespace
}  // namespace kaustik
