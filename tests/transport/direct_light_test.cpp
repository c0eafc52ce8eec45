// Light sampled at a receiver: the recursion level that lights are asked with, and the numbers of
// shadow rays.

#include "kaustik/transport/direct_light.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "tests/support/strip_mesh.h"
#include "tests/transport/scene_of.h"

namespace kaustik {
namespace {

using test::scene_of;

/// The floor at the origin, seen from above.
SurfaceVertex vertex_at(const Scene& scene, const Vec3f& position) {
  const Ray ray{position + Vec3f(0, 0, 0.1f), {0, 0, -1}};
  Hit hit;
  EXPECT_TRUE(scene.intersect(ray, hit));
  return {scene, ray, hit, TransportMode::radiance};
}

/// A long strip of lamps over one end of a floor: by area alone most samples are wasted on its far
/// end.
class FloorUnderAStrip {
 public:
  std::shared_ptr<const Scene> scene() const {
    return scene_of(
        "<shape type=\"rectangle\"/>" +
        strip_.shape(R"(<scale value="4,0.1,1"/><rotate x="1" angle="180"/>
                                    <translate x="3.8" z="0.5"/>)",
                     R"(<emitter type="area"><rgb name="radiance" value="3"/></emitter>)"));
  }

 private:
  test::StripMesh strip_{64};
};

/// In proportion to what each of many point lamps brings, the last ones like the first.
TEST(LightShares, AreThoseOfManyLights) {
  std::string lamps;
  const auto intensity_of = [](int lamp) { return 1 + lamp % 7; };
  for (int i = 0; i < 70; ++i)
    lamps += fmt::format(
        R"(<emitter type="point"><point name="position" x="0" y="0" z="{}"/>
           <rgb name="intensity" value="{}"/></emitter>)",
        i % 10 == 9 ? -1 : 1, intensity_of(i));
  const auto scene = scene_of("<shape type=\"rectangle\"/>" + lamps);
  const LightShares shares(*scene, vertex_at(*scene, {0, 0, 0}), 1000);
  int total = 0;
  for (int i = 0; i < 70; ++i)
    if (i % 10 != 9) total += intensity_of(i);
  for (int i = 0; i < 70; ++i) {
    const int expected =
        i % 10 == 9 ? 0 : int(std::round(1000.0 * intensity_of(i) / double(total)));
    EXPECT_EQ(shares.samples_of(size_t(i)), expected) << i;
  }
}

/// What is known arrives without a ray; of the rest a ray tells.
TEST(DirectLight, ArrivesAsFarAsItIsKnownOrSeen) {
  class Known final : public VisibilityEstimator {
   public:
    explicit Known(const VisibilityEstimate& answer) : answer_(answer) {}
    VisibilityEstimate of(int) override { return answer_; }

   private:
    VisibilityEstimate answer_;
  };
  const auto share = [](bool hidden, VisibilityEstimator* sight, uint64_t& rays) {
    const std::string wall =
        R"(<shape type="disk"><transform name="to_world"><translate z="0.5"/></transform></shape>)";
    const auto scene = scene_of(
        "<shape type=\"rectangle\"/><emitter type=\"point\"><point name=\"position\" x=\"0\" "
        "y=\"0\" z=\"1\"/></emitter>" +
        (hidden ? wall : ""));
    const Receiver receiver(vertex_at(*scene, {0, 0, 0}));
    Sampler sampler(1, 0);
    DirectLight light;
    EXPECT_TRUE(sample_direct_light(*scene, receiver, sampler, light));
    ShadowAnswer answer{};
    return arriving_share(*scene, light, sight, nullptr, {{}, sampler}, rays, answer)[0];
  };
  uint64_t rays = 0;
  Known lit({1, 0}), mixed({0.25f, 0.5f});
  EXPECT_EQ(share(true, &lit, rays), 1);
  EXPECT_EQ(rays, 0u);
  EXPECT_EQ(share(true, &mixed, rays), 0.25f);
  EXPECT_EQ(share(false, &mixed, rays), 0.75f);
  EXPECT_EQ(share(true, nullptr, rays), 0);
  EXPECT_EQ(share(false, nullptr, rays), 1);
  EXPECT_EQ(rays, 4u);
}

/// The deeper the level the noisier, and the mean stays.
TEST(RecursionLevel, MakesLightsCoarserAndKeepsTheirMean) {
  const auto scene = FloorUnderAStrip().scene();
  std::vector<RunningStatistics> irradiances;
  for (const int level : {0, 1, 7}) {
    const Receiver receiver(vertex_at(*scene, {0, 0, 0}), level);
    RunningStatistics irradiance;
    for (uint32_t i = 0; i < (level == 7 ? 1'000'000u : 200'000u); ++i) {
      Sampler sampler(hash_mix(21 + uint64_t(level), i), 0);
      DirectLight light;
      double value = 0;
      if (sample_direct_light(*scene, receiver, sampler, light) &&
          !scene->occluded(light.shadow_ray))
        value = double(light.radiance[0]) * std::max(0.0, double(light.wi.z));
      irradiance.add(value);
    }
    EXPECT_LT(irradiance.standard_error(), 0.003 * irradiance.mean()) << level;
    irradiances.push_back(irradiance);
  }
  for (const size_t deep : {1, 2}) {
    const RunningStatistics &a = irradiances[0], &b = irradiances[deep];
    const double error = std::hypot(a.standard_error(), b.standard_error());
    EXPECT_GT(z_test_p_value(a.mean(), error, b.mean()), 1e-3) << deep;
    EXPECT_LT(z_test_p_value(1.02 * a.mean(), error, b.mean()), 1e-3) << deep;
  }
  EXPECT_GT(irradiances[2].variance(), 2 * irradiances[0].variance());
}

/// What a sample reports is what is answered for its point later, at the same level.
TEST(RecursionLevel, DensitiesFollowIt) {
  const auto scene = FloorUnderAStrip().scene();
  const SurfaceVertex vertex = vertex_at(*scene, {0, 0, 0});
  for (const int level : {0, 2, 3, 7}) {
    const Receiver receiver(vertex, level), at_next(vertex, level == 0 ? 7 : 0);
    double largest_difference = 0;
    for (uint32_t i = 0; i < 2000; ++i) {
      Sampler sampler(hash_mix(29, i), 0);
      DirectLight light;
      if (!sample_direct_light(*scene, receiver, sampler, light)) continue;
      const Ray ray = spawn_ray(vertex.point(), light.wi);
      Hit hit;
      // Grazing rays may miss the triangle for a neighbour.
      if (!scene->intersect(ray, hit)) continue;
      const SurfacePoint on_light = scene->tracer().surface_point(ray, hit);
      if (dot(on_light.ng, light.wi) > -0.05f || scene->occluded(light.shadow_ray)) continue;
      const auto pdf = [&](const Receiver& asked, LightChoice choice) {
        return double(direct_light_pdf(*scene, asked.query(), choice, 0, on_light));
      };
      const double reported = double(light.pdf_solid_angle);
      ASSERT_NEAR(pdf(receiver, LightChoice::one), reported, 2e-3 * reported) << level;
      ASSERT_NEAR(pdf(receiver, LightChoice::all), reported, 2e-3 * reported) << level;
      largest_difference = std::max(
          largest_difference, std::fabs(pdf(at_next, LightChoice::one) - reported) / reported);
    }
    EXPECT_GT(largest_difference, 0.1) << level;
  }
}

constexpr double intensity = 5, height = 2, ball_radius = 0.5;

/// A floor, a lamp 2 m above its origin, and a screen halfway up whose edge is the line x = 0: the
/// shadow's edge at the origin is the middle of its penumbra.
std::shared_ptr<const Scene> floor_half_in_shadow(const std::string& lamp) {
  return scene_of(
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"9\"/></transform>"
      "</shape><shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"2\"/>"
      "<translate x=\"-2\" z=\"1\"/></transform></shape>" +
      lamp);
}
std::string ball(int shadow_samples) {
  return fmt::format(
      R"(<emitter type="distributed"><point name="position" value="0, 0, {}"/>
      <float name="radius" value="{}"/><float name="intensity" value="{}"/>
      <integer name="shadow_samples" value="{}"/></emitter>)",
      height, ball_radius, intensity, shadow_samples);
}
/// The same as a surface.
std::string sphere(int shadow_samples) {
  return fmt::format(
      R"(<shape type="sphere"><point name="center" value="0, 0, {}"/>
      <float name="radius" value="{}"/><emitter type="area">
      <rgb name="radiance" value="{}"/><integer name="shadow_samples" value="{}"/></emitter></shape>)",
      height, ball_radius, intensity / (std::numbers::pi * ball_radius * ball_radius),
      shadow_samples);
}

struct Measured {
  RunningStatistics irradiance, rays;
};
/// What arrives on the floor at `x`.
Measured measure(const Scene& scene, float x, int level = 0, uint32_t count = 20'000,
                 LightChoice choice = LightChoice::one) {
  const Receiver receiver(vertex_at(scene, {x, 0, 0}), level);
  Measured result;
  for (uint32_t i = 0; i < count; ++i) {
    Sampler sampler(hash_mix(31, i), 0);
    uint64_t rays = 0;
    const auto irradiance = sample_direct_lights<double>(
        scene, receiver, {choice, 1}, sampler, [&](const DirectLight& light, ShadowAnswer& answer) {
          const Spectrum seen =
              trace_shadow_ray(scene, light, nullptr, {{}, sampler}, rays, answer);
          return double((light.radiance * seen)[0]) * std::max(0.0, double(light.wi.z));
        });
    result.irradiance.add(irradiance);
    result.rays.add(double(rays));
  }
  return result;
}
/// Of the whole lamp (a ball gives what a point in its middle would give).
double unshadowed(double x) { return intensity * height / std::pow(x * x + height * height, 1.5); }

void expect_mean(const RunningStatistics& values, double expected) {
  EXPECT_LT(values.standard_error(), 0.003 * expected);
  EXPECT_GT(z_test_p_value(values, expected), 1e-3) << values.mean() << " " << expected;
  EXPECT_LT(z_test_p_value(values, 1.02 * expected), 1e-3);
}

/// A quarter of the rays where they agree. In the middle of the penumbra each of the eight groups
/// of four is traced in full with the chance that seven rays do not agree.
TEST(ShadowSamples, AreSpentInThePenumbra) {
  for (const auto& lamp : {ball(32), sphere(32)}) {
    const auto scene = floor_half_in_shadow(lamp);
    const Measured lit = measure(*scene, 1.5f), dark = measure(*scene, -1.5f),
                   middle = measure(*scene, 0);
    expect_mean(lit.irradiance, unshadowed(1.5));
    EXPECT_EQ(lit.rays.mean(), 8);
    EXPECT_EQ(dark.irradiance.mean(), 0);
    EXPECT_EQ(dark.rays.mean(), 8);
    expect_mean(middle.irradiance, 0.5 * unshadowed(0));
    const double all_agree = 2 / 128.0;
    EXPECT_GT(z_test_p_value(middle.rays, 8 * (all_agree + (1 - all_agree) * 4)), 1e-3)
        << middle.rays.mean();
  }
}

/// The number of rays depends on what they find, the mean does not: at all places of the penumbra
/// it is that of single rays.
TEST(ShadowSamples, KeepTheMean) {
  const auto one = floor_half_in_shadow(ball(1)), many = floor_half_in_shadow(ball(32)),
             few = floor_half_in_shadow(ball(6));
  for (const float x : {-0.25f, 0.1f, 0.3f}) {
    const Measured by_one = measure(*one, x, 0, 400'000);
    EXPECT_EQ(by_one.rays.mean(), 1);
    for (const auto& scene : {many, few}) {
      const Measured adaptive = measure(*scene, x, 0, scene == many ? 40'000 : 80'000);
      const double error =
          std::hypot(adaptive.irradiance.standard_error(), by_one.irradiance.standard_error());
      EXPECT_GT(z_test_p_value(adaptive.irradiance.mean(), error, by_one.irradiance.mean()), 1e-3)
          << x << ": " << adaptive.irradiance.mean() << " " << by_one.irradiance.mean();
      EXPECT_LT(z_test_p_value(1.03 * adaptive.irradiance.mean(), error, by_one.irradiance.mean()),
                1e-3)
          << x;
    }
  }
}

/// In the middle of the penumbra there is nearly the noise of all the rays.
TEST(ShadowSamples, BringLessNoise) {
  const auto variance = [](int shadow_samples) {
    return measure(*floor_half_in_shadow(ball(shadow_samples)), 0).irradiance.variance();
  };
  const double one = variance(1), first = variance(8), adaptive = variance(32);
  std::printf("  variance over that of one ray: of up to eight %.3f, of up to 32 %.3f\n",
              first / one, adaptive / one);
  EXPECT_LT(first, 0.25 * one);
  EXPECT_LT(adaptive, 0.06 * one);
}

/// Half as many at each level, down to one; with several lights each has its own number.
TEST(ShadowSamples, FallWithTheLevel) {
  const auto scene = floor_half_in_shadow(ball(16));
  const std::pair<int, double> lit[] = {{1, 4}, {2, 4}, {3, 2}, {4, 1}, {9, 1}};
  for (const auto& [level, rays] : lit)
    EXPECT_EQ(measure(*scene, 1.5f, level, 100).rays.mean(), rays) << level;
  const auto two = floor_half_in_shadow(
      ball(16) + "<emitter type=\"point\"><point name=\"position\" value=\"0, 0, 3\"/></emitter>");
  EXPECT_EQ(measure(*two, 1.5f, 0, 100, LightChoice::all).rays.mean(), 5);
}

}  // namespace
}  // namespace kaustik
