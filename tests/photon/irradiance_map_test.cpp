#include "kaustik/photon/irradiance_map.h"

#include <gtest/gtest.h>

#include <random>

#include "kaustik/base/parallel.h"
#include "kaustik/base/statistics.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int sample_divisor = 10;
#else
constexpr int sample_divisor = 1;
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
    photon.flux.fill((front ? 1.0f : 100.0f) / float(count));
    photon.side = CoarseNormal(front ? up : -up);
    photons.push_back(photon);
  }
  return {std::move(positions), std::move(photons)};
}

/// What lookups make of the irradiance, over estimates at the very places, at which the same
/// photons are found: apart from one another by far less than either from the truth.
RunningStatistics lookups_over_estimates(size_t stride, bool at_photons) {
  EstimateSettings settings;
  settings.neighbors = 50;
  RunningStatistics ratio;
  for (int map_index = 0; map_index < std::max(3, 16 / sample_divisor); ++map_index) {
    const PhotonMap photons = two_sided_map(10'000, uint64_t(map_index) + 1);
    const IrradianceMap map(photons, settings, stride);
    RunningStatistics looked_up, estimated;
    for (int i = 0; i < 4000; ++i) {
      const float x = 0.1f + 0.8f * float(i % 64) / 64, y = 0.1f + 0.8f * float(i) / 4000;
      const Vec3f photon = photons.tree().key(uint32_t(i));
      const bool inside =
          std::min(photon.x, photon.y) > 0.1f && std::max(photon.x, photon.y) < 0.9f;
      Spectrum irradiance;
      if (map.lookup(at_photons && inside ? photon : Vec3f(x, y, 0), up, irradiance))
        looked_up.add(double(irradiance[0]));
      estimated.add(double(photons.irradiance({x, y, 0}, up, settings).value[0]));
    }
    EXPECT_EQ(looked_up.count(), estimated.count());
    ratio.add(looked_up.mean() / estimated.mean());
  }
  return ratio;
}

/// An estimate that stands at a photon counts that one too many, but what is looked up from an even
/// place is far in sparse regions just as much: to the first order the mean is right. The test
/// allows for half a percent of what is left.
TEST(IrradianceMap, HasTheRightMean) {
  for (const size_t stride : {size_t(1), size_t(4)}) {
    const RunningStatistics ratio = lookups_over_estimates(stride, false);
    EXPECT_NEAR(ratio.mean(), 1, 0.005 + 4 * ratio.standard_error()) << "stride " << stride;
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(ratio.standard_error(), 0.001) << "stride " << stride;
#endif
  }
#ifndef KAUSTIK_SLOW_BUILD
  // Looked up at the photons themselves nothing makes up for that: 1/(k - 2) too much.
  EXPECT_GT(lookups_over_estimates(1, true).mean(), 1.01);
#endif
}

TEST(IrradianceMap, KnowsSidesAndItsReach) {
  EstimateSettings settings;
  const IrradianceMap map(two_sided_map(5000, 3), settings, 3);
  EXPECT_FALSE(map.empty());
  Spectrum above, below, none;
  ASSERT_TRUE(map.lookup({0.5f, 0.5f, 0}, up, above));
  ASSERT_TRUE(map.lookup({0.5f, 0.5f, 0}, -up, below));
  EXPECT_NEAR(above[0], 1, 0.6f);
  EXPECT_NEAR(below[0], 100, 60);
  EXPECT_FALSE(map.lookup({0.5f, 0.5f, 0}, {1, 0, 0}, none));
  EXPECT_FALSE(map.lookup({0.5f, 0.5f, 0.4f}, up, none));
}

TEST(IrradianceMap, EmptyFromNothing) {
  Spectrum irradiance;
  EXPECT_FALSE(IrradianceMap().lookup({0, 0, 0}, up, irradiance));
  EXPECT_TRUE(IrradianceMap(PhotonMap(), {}, 4).empty());
  EstimateSettings off;
  off.neighbors = 0;
  EXPECT_TRUE(IrradianceMap(two_sided_map(100, 1), off, 4).empty());
}

TEST(IrradianceMap, SameForAnyNumberOfThreads) {
  const PhotonMap photons = two_sided_map(5000, 9);
  const auto values = [&](int threads) {
    std::vector<float> result;
    with_threads(threads, [&] {
      const IrradianceMap map(photons, {}, 4);
      for (float x = 0; x < 1; x += 0.01f) {
        Spectrum irradiance;
        map.lookup({x, x, 0}, up, irradiance);
        result.push_back(irradiance[0]);
      }
    });
    return result;
  };
  EXPECT_EQ(values(1), values(2));
}

}  // namespace
}  // namespace kaustik
