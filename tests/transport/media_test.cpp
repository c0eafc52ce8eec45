// Light paths and shadow rays in media.

#include <gtest/gtest.h>

#include <numbers>

#include "kaustik/base/statistics.h"
#include "kaustik/base/warp.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/transport/light_path.h"
#include "kaustik/transport/visibility.h"
#include "tests/transport/scene_of.h"

namespace kaustik {
namespace {

using test::scene_of;

constexpr double level = 1e-4;

std::string shape(const std::string& type, const std::string& parameters,
                  const std::string& sigma_t = "", const std::string& albedo = "0.6, 0.9, 0.3") {
  std::string medium;
  if (!sigma_t.empty())
    medium = "<medium name=\"interior\" type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"" +
             sigma_t + "\"/><rgb name=\"albedo\" value=\"" + albedo +
             "\"/><phase type=\"hg\"><float name=\"g\" value=\"0.4\"/></phase></medium>";
  return "<shape type=\"" + type + "\">" + parameters + medium + "</shape>";
}
std::string ball(double radius, const std::string& bsdf, const std::string& sigma_t = "",
                 const std::string& albedo = "0.6, 0.9, 0.3") {
  return shape("sphere", "<float name=\"radius\" value=\"" + std::to_string(radius) + "\"/>" + bsdf,
               sigma_t, albedo);
}
const std::string null_bsdf = "<bsdf type=\"null\"/>";
const std::string black = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>";

const Sampler numbers(1, 2);
const LightOnItsWay white{{}, numbers};

/// Two balls of haze, one in the other: shadow rays across both, to a point and to infinity.
TEST(ShadowRays, PassNullBoundariesAndMedia) {
  const auto scene = scene_of(ball(2, null_bsdf, "0.5, 1, 0") + ball(1, null_bsdf, "2, 0, 1"));
  SurfacePoint outside;
  outside.position = {0, 0, -5};
  uint64_t rays = 0;
  // After the inner ball the outer medium is unknown to the inner one: its exterior is vacuum.
  const Spectrum to_point =
      transmittance_on_way(*scene, spawn_ray_to(outside, Vec3f(0, 0, 5)), nullptr, white, rays);
  EXPECT_NEAR(to_point[0], std::exp(-0.5 - 4), 1e-6);
  EXPECT_NEAR(to_point[1], std::exp(-1.0), 1e-6);
  EXPECT_NEAR(to_point[2], std::exp(-2.0), 1e-6);
  EXPECT_EQ(rays, 5u);
  const Spectrum to_infinity =
      transmittance_on_way(*scene, spawn_ray(outside, {0, 0, 1}), nullptr, white, rays);
  for (int lane = 0; lane < 3; ++lane) EXPECT_NEAR(to_infinity[lane], to_point[lane], 1e-6);
  // It may end in a medium, and start in one.
  const Spectrum to_center =
      transmittance_on_way(*scene, spawn_ray_to(outside, Vec3f(0, 0, 0)), nullptr, white, rays);
  EXPECT_NEAR(to_center[0], std::exp(-0.5 - 2), 1e-6);
  SurfacePoint center;
  const Spectrum from_center = transmittance_on_way(*scene, spawn_ray_to(center, Vec3f(0, 0, 0.5f)),
                                                    scene->surface(1).interior.get(), white, rays);
  EXPECT_NEAR(from_center[2], std::exp(-0.5), 1e-6);
}

/// Each lane loses what its own wavelength loses.
TEST(ShadowRays, FollowTheWavelengths) {
  const auto scene = scene_of(
      R"(<shape type="sphere"><bsdf type="null"/><medium name="interior" type="homogeneous">
      <spectrum name="sigma_t" value="400:0, 800:1"/></medium></shape>)");
  SurfacePoint outside;
  outside.position = {0, 0, -5};
  uint64_t rays = 0;
  const Spectrum left = transmittance_on_way(*scene, spawn_ray_to(outside, Vec3f(0, 0, 5)), nullptr,
                                             {{440, 500, 580, 660}, numbers}, rays);
  const double extinctions[] = {0.1, 0.25, 0.45, 0.65};
  for (int lane = 0; lane < 4; ++lane)
    EXPECT_NEAR(left[lane], std::exp(-2 * extinctions[lane]), 1e-5) << lane;
}

TEST(ShadowRays, AreBlockedByWhatIsMoreThanABoundary) {
  for (const std::string& bsdf : {black, std::string("<bsdf type=\"dielectric\"/>")}) {
    const auto scene = scene_of(ball(2, null_bsdf, "0.5, 1, 0") + ball(1, bsdf));
    SurfacePoint outside;
    outside.position = {0, 0, -5};
    uint64_t rays = 0;
    EXPECT_TRUE(
        transmittance_on_way(*scene, spawn_ray_to(outside, Vec3f(0, 0, 5)), nullptr, white, rays)
            .is_zero());
  }
}

/// A lamp of 1 W in the centre of a ball of haze in a black shell: what arrives there and what the
/// medium absorbs on the way.
struct Balance {
  std::array<RunningStatistics, 3> arrived, absorbed;
  LightPathCounts counts;
};

Balance balance_of(const Scene& scene, uint32_t count, double lost_share = 0) {
  Balance balance;
  constexpr uint32_t block = 256;
  for (uint32_t begin = 0; begin < count; begin += block) {
    Spectrum arrived, absorbed;
    const auto emit = [&](uint32_t i) -> std::optional<LightPath> {
      Sampler sampler(hash_mix(5, i), 0);
      const Vec3f direction = square_to_sphere(sampler.next_2d());
      return LightPath({{0, 0, 0}, direction, infinity}, Spectrum(1, 1, 1, 0),
                       scene.surface(0).interior.get(), Lobes::specular, sampler, {});
    };
    const auto surface = [&](const LightVertex& at) {
      arrived += at.state.throughput;
      return Lobes::none;
    };
    const auto in_medium = [&](const LightMediumVertex& at) {
      // What is absorbed is to what is scattered as σ_a to σ_s.
      const Spectrum scattering = at.medium.scattering(at.position, {});
      const Spectrum extinction = at.medium.extinction(at.position, {});
      for (int lane = 0; lane < 3; ++lane)
        absorbed.set(lane,
                     absorbed[lane] + at.flux[lane] * (extinction[lane] / scattering[lane] - 1));
    };
    const LightPathCounts counts =
        trace_light_paths(scene, begin, begin + block, {}, emit, Handlers{surface, in_medium});
    balance.counts.absorbed_in_media += counts.absorbed_in_media;
    balance.counts.stopped += counts.stopped;
    balance.counts.escaped += counts.escaped;
    for (int lane = 0; lane < 3; ++lane) {
      balance.arrived[size_t(lane)].add(double(arrived[lane]) / block);
      balance.absorbed[size_t(lane)].add(double(absorbed[lane]) / block * (1 - lost_share));
    }
  }
  return balance;
}

constexpr uint32_t path_count = 1 << 16;

/// Emitted = arrived + absorbed, for every lane, with means of independent blocks; a twin that
/// loses 5 % of what is absorbed fails.
TEST(LightPaths, KeepTheBalanceOfEnergyInMedia) {
  const auto scene = scene_of(ball(1, null_bsdf, "0.5, 2, 4") + ball(1.5, black));
  for (const double lost : {0.0, 0.05}) {
    const Balance balance = balance_of(*scene, path_count, lost);
    EXPECT_EQ(balance.counts.escaped, 0u);
    EXPECT_EQ(balance.counts.stopped + balance.counts.absorbed_in_media, path_count);
    for (size_t lane = 0; lane < 3; ++lane) {
      const double sum = balance.arrived[lane].mean() + balance.absorbed[lane].mean();
      const double error = std::hypot(balance.arrived[lane].standard_error(),
                                      balance.absorbed[lane].standard_error());
      std::printf("  lane %zu: arrived %.5f + absorbed %.5f = %.5f ± %.5f\n", lane,
                  balance.arrived[lane].mean(), balance.absorbed[lane].mean(), sum, error);
      if (lost == 0) {
        EXPECT_GT(z_test_p_value(sum, error, 1), level);
        EXPECT_LT(error, 0.01);
      } else if (lane == 2) {
        EXPECT_LT(z_test_p_value(sum, error, 1), level);
      }
    }
  }
}

/// Without scattering the shell gets exp(−σ r) of the light.
TEST(LightPaths, AreAttenuatedByBeerAndLambert) {
  const auto scene = scene_of(ball(1, null_bsdf, "0.5, 1, 1.5", "0, 0, 0") + ball(1.5, black));
  const Balance balance = balance_of(*scene, path_count);
  for (size_t lane = 0; lane < 3; ++lane) {
    const double expected = std::exp(-0.5 * double(lane + 1));
    EXPECT_GT(z_test_p_value(balance.arrived[lane], expected), level);
    EXPECT_LT(balance.arrived[lane].standard_error(), 0.01 * expected);
    EXPECT_EQ(balance.absorbed[lane].mean(), 0);  // nothing scatters, so nothing is shown
  }
}

/// Light in a white medium without an end comes to an end too.
TEST(LightPaths, EndInAnEndlessWhiteMedium) {
  const auto scene = build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><medium type=\"homogeneous\">"
      "<rgb name=\"albedo\" value=\"1\"/></medium></sensor><shape type=\"sphere\"/></scene>",
      "test.xml", ""));
  const auto emit = [&](uint32_t i) -> std::optional<LightPath> {
    return LightPath({{0, 0, 5}, {0, 0, 1}, infinity}, Spectrum(1), scene->camera_medium(),
                     Lobes::specular, Sampler(hash_mix(6, i), 0), {});
  };
  const LightPathCounts counts = trace_light_paths(
      *scene, 0, 1000, {}, emit, [](const LightVertex& at) { return at.vertex.lobes(); });
  EXPECT_EQ(counts.absorbed_in_media + counts.absorbed, 1000u);
}

TEST(LightPaths, StopWhereTheyMayNotScatter) {
  const auto scene = scene_of(ball(1, null_bsdf, "3, 3, 3", "1, 1, 1") + ball(1.5, black));
  const auto emit = [&](uint32_t i) -> std::optional<LightPath> {
    Sampler sampler(hash_mix(7, i), 0);
    const Vec3f direction = square_to_sphere(sampler.next_2d());
    return LightPath({{0, 0, 0}, direction, infinity}, Spectrum(1),
                     scene->surface(0).interior.get(), Lobes::specular, sampler, {});
  };
  uint32_t arrived = 0;
  const auto surface = [&](const LightVertex& at) {
    EXPECT_EQ(at.path_class.events(), 0);
    EXPECT_NEAR(at.distance, 1.5f, 1e-4f);
    ++arrived;
    return Lobes::none;
  };
  LightPathLimits limits;
  for (const MediumEvents in_media : {MediumEvents::stop, MediumEvents::after_events}) {
    limits.in_media = in_media;
    arrived = 0;
    const LightPathCounts counts = trace_light_paths(*scene, 0, 20'000, limits, emit, surface);
    EXPECT_EQ(counts.stopped, 20'000u);
    EXPECT_GT(z_test_p_value(arrived / 2e4, std::sqrt(0.0498 * 0.95 / 2e4), std::exp(-3.0)), level);
  }
}

}  // namespace
}  // namespace kaustik
