#include "kaustik/photon/irradiance_map.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "kaustik/base/parallel.h"
#include "kaustik/base/statistics.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int map_divisor = 10;
#else
constexpr int map_divisor = 1;
#endif

const Vec3f up(0, 0, 1);

/// Photons on the unit square; irradiance 1 from above, 100 from below, apart by hardly anything.
PhotonMap two_sided_map(size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> number;
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;
  for (size_t i = 0; i < 2 * count; ++i) {
    const float x = number(random);
    const bool front = i % 2 == 0;
    positions.push_back({x, number(random), front ? 1e-5f : -1e-5f});
    Photon photon;
    photon.flux.lanes.fill((front ? 1.0f : 100.0f) / float(count));
    photon.side = CoarseNormal(front ? up : -up);
    photon.path = uint32_t(i);
    photons.push_back(photon);
  }
  return {std::move(positions), std::move(photons)};
}

/// As many places as photons/stride, where other photons of the same kind landed.
std::vector<SurfaceSide> other_places(size_t count, size_t stride, uint64_t seed) {
  const PhotonMap map = two_sided_map(count / stride, seed + 1000);
  std::vector<SurfaceSide> places;
  for (uint32_t i = 0; i < map.size(); ++i)
    places.push_back({map.tree().key(i), map.tree().data(i).side});
  return places;
}

std::vector<SurfaceSide> own_places(const PhotonMap& map, size_t stride) {
  std::vector<SurfaceSide> places;
  for (size_t i = 0; i < map.size(); i += stride)
    places.push_back({map.tree().key(uint32_t(i)), map.tree().data(uint32_t(i)).side});
  return places;
}

/// What lookups make of the irradiance, over estimates from the same photons at the very points:
/// these two are apart from one another by far less than either from the truth.
RunningStatistics lookups_over_estimates(int neighbors, size_t stride, bool at_own_photons) {
  constexpr size_t count = 10'000;
  EstimateSettings settings;
  settings.neighbors = neighbors;
  RunningStatistics ratio;
  for (int map_index = 0; map_index < std::max(3, 24 / map_divisor); ++map_index) {
    const auto seed = uint64_t(map_index) + 1;
    const PhotonMap photons = two_sided_map(count, seed);
    const IrradianceMap map(
        photons, at_own_photons ? own_places(photons, stride) : other_places(count, stride, seed),
        settings);
    Scratch scratch;
    RunningStatistics looked_up, estimated;
    for (int i = 0; i < 4000; ++i) {
      const Vec3f at(0.1f + 0.8f * float(i % 64) / 64, 0.1f + 0.8f * float(i) / 4000, 0);
      const float estimate = photons.irradiance(at, up, settings, scratch).value[0];
      Spectrum irradiance;
      // As gather rays do it: where nothing is near, the estimate itself.
      looked_up.add(double(map.lookup(at, up, irradiance, scratch) ? irradiance[0] : estimate));
      estimated.add(double(estimate));
    }
    ratio.add(looked_up.mean() / estimated.mean());
  }
  return ratio;
}

/// Also with so few neighbours that an estimate hardly reaches from one place to the next.
TEST(IrradianceMap, HasTheRightMean) {
  struct Case {
    int neighbors;
    size_t stride;
  };
  for (const Case& c : {Case{50, 1}, Case{50, 4}, Case{20, 4}, Case{12, 4}}) {
    const RunningStatistics ratio = lookups_over_estimates(c.neighbors, c.stride, false);
    std::printf("  lookups over estimates, %d neighbours, stride %zu: %.5f ± %.5f\n", c.neighbors,
                c.stride, ratio.mean(), ratio.standard_error());
    EXPECT_GT(z_test_p_value(ratio, 1), 1e-4) << c.neighbors << " " << c.stride;
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(ratio.standard_error(), 0.002) << c.neighbors << " " << c.stride;
#endif
  }
#ifndef KAUSTIK_SLOW_BUILD
  // The map's own photons as places: those near an even point tend to have sparse surroundings.
  EXPECT_LT(z_test_p_value(lookups_over_estimates(12, 4, true), 1), 1e-4);
#endif
}

TEST(IrradianceMap, KnowsSidesAndItsReach) {
  EstimateSettings settings;
  settings.maximum_radius = 0.3f;
  const IrradianceMap map(two_sided_map(5000, 3), other_places(5000, 3, 3), settings);
  EXPECT_FALSE(map.empty());
  Spectrum above, below, none;
  Scratch scratch;
  ASSERT_TRUE(map.lookup({0.5f, 0.5f, 0}, up, above, scratch));
  ASSERT_TRUE(map.lookup({0.5f, 0.5f, 0}, -up, below, scratch));
  EXPECT_NEAR(above[0], 1, 0.6f);
  EXPECT_NEAR(below[0], 100, 60);
  EXPECT_FALSE(map.lookup({0.5f, 0.5f, 0}, {1, 0, 0}, none, scratch));
  EXPECT_FALSE(map.lookup({0.5f, 0.5f, 0.4f}, up, none, scratch));
}

TEST(IrradianceMap, EmptyFromNothing) {
  Spectrum irradiance;
  Scratch scratch;
  EXPECT_FALSE(IrradianceMap().lookup({0, 0, 0}, up, irradiance, scratch));
  EXPECT_TRUE(IrradianceMap(PhotonMap(), other_places(100, 1, 1), {}).empty());
  EstimateSettings off;
  off.neighbors = 0;
  EXPECT_TRUE(IrradianceMap(two_sided_map(100, 1), other_places(100, 1, 1), off).empty());
  EXPECT_TRUE(IrradianceMap(two_sided_map(100, 1), {}, {}).empty());
}

TEST(IrradianceMap, EmptyOnceStopped) {
  std::stop_source stop;
  stop.request_stop();
  const IrradianceMap map(two_sided_map(100, 1), other_places(100, 1, 1), {}, nullptr,
                          stop.get_token());
  EXPECT_TRUE(map.empty());
}

TEST(IrradianceMap, SameForAnyNumberOfThreads) {
  const PhotonMap photons = two_sided_map(5000, 9);
  const auto values = [&](int threads) {
    std::vector<float> result;
    with_threads(threads, [&] {
      Scratch scratch;
      const IrradianceMap map(photons, other_places(5000, 4, 9), {});
      for (float x = 0; x < 1; x += 0.01f) {
        Spectrum irradiance;
        map.lookup({x, x, 0}, up, irradiance, scratch);
        result.push_back(irradiance[0]);
      }
    });
    return result;
  };
  EXPECT_EQ(values(1), values(2));
}

}  // namespace
}  // namespace kaustik
