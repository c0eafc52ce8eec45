// Glowing balls that nothing meets.

#include <gtest/gtest.h>

#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

const Vec3f middle(1, 2, 3);
constexpr float radius = 0.5f;

std::unique_ptr<Light> make_distributed(std::vector<Property> properties = {}) {
  properties.push_back({"position", Value(Vec3d(middle)), {}});
  properties.push_back({"radius", Value(double(radius)), {}});
  return make_light("distributed", properties);
}

std::unique_ptr<Light> make_distributed_spot(double cutoff) {
  const Vec3d at(middle);
  return make_light(
      "distributedspot",
      {{"radius", Value(double(radius)), {}},
       {"cutoff_angle", Value(cutoff), {}},
       {"to_world", Value(Transform::look_at(at, at + Vec3d(0, 0, -1), {0, 1, 0})), {}}});
}

TEST(DistributedLight, IsSampledInTheConeThatItFills) {
  const auto light = make_distributed();
  const Vec3f reference(1, 1, 1.5f);
  const Vec3f to_middle = middle - reference;
  DirectionGrid grid;
  grid.axis = normalize(to_middle);
  grid.one_minus_cos = 1.0f - safe_sqrt(1.0f - sqr(radius) / length_sq(to_middle));
  Random random(3);
  float pdf = 0;
  const auto sample = [&] {
    const LightSample s = light->sample_toward(reference, random.next_2d());
    pdf = s.pdf_solid_angle;
    return s.direction;
  };
  sample();
  EXPECT_NEAR(pdf, 1 / (2 * pi * grid.one_minus_cos), 1e-3f * pdf);
  const auto density = [&](const Vec3f&) { return double(pdf); };
  const int count = 500'000 / sample_share;
  EXPECT_GT(direction_p_value(grid, count, sample, density), failure_level);
  expect_twin_fails(
      [&] { return direction_p_value(grid, count, sample, with_planted_error(grid, density)); });
}

/// W/m² on a surface that faces the light's centre.
RunningStatistics irradiance(const Light& light, const Vec3f& reference) {
  RunningStatistics result;
  Random random(5);
  const Vec3f normal = normalize(middle - reference);
  for (int i = 0; i < 200'000 / sample_share; ++i) {
    const LightSample s = light.sample_toward(reference, random.next_2d());
    EXPECT_TRUE(s.only_sampled && !s.delta && !s.on_surface);
    result.add(s.pdf_solid_angle > 0
                   ? s.radiance[0] * std::max(0.0f, dot(s.direction, normal)) / s.pdf_solid_angle
                   : 0.0);
  }
  return result;
}

void expect_mean(const RunningStatistics& values, double expected) {
  EXPECT_GT(z_test_p_value(values, expected), failure_level)
      << values.mean() << " ± " << values.standard_error() << ", not " << expected;
  if (!twins_can_fail) return;
  EXPECT_LT(values.standard_error(), 0.003 * expected);
  expect_twin_fails(z_test_p_value(values, 1.02 * expected));
}

TEST(DistributedLight, GivesWhatAPointOfItsIntensityGives) {
  const auto light = make_distributed({{"intensity", Value(7.0), {}}});
  for (const Vec3f& reference : {Vec3f(1, 2, 5), Vec3f(1, 2, 3.8f)})
    expect_mean(irradiance(*light, reference), 7 / length_sq(reference - middle));
  EXPECT_NEAR(light->traits().power[0], 28 * pi, 1e-4);
}

TEST(DistributedLight, TakesItsPowerInstead) {
  const auto light = make_distributed({{"power", Value(4.0 * std::numbers::pi), {}}});
  EXPECT_NEAR(light->traits().power[1], 4 * pi, 1e-5);
  expect_mean(irradiance(*light, {1, 2, 5}), 0.25);
}

TEST(DistributedLight, GivesNothingInside) {
  const auto light = make_distributed();
  EXPECT_EQ(light->sample_toward(middle + Vec3f(0.1f, 0, 0), {0.3f, 0.3f}).pdf_solid_angle, 0);
}

/// Far below the spot its cone is wide and the ball small: intensity over the squared distance.
TEST(DistributedSpot, ShinesIntoItsCone) {
  const auto light = make_distributed_spot(40);
  expect_mean(irradiance(*light, {1, 2, 0}), 1 / 9.0);
  EXPECT_EQ(irradiance(*light, {1, 2, 5}).mean(), 0);
  EXPECT_EQ(irradiance(*light, {4, 2, 3}).mean(), 0);
  const auto plain = make_light("spot", {{"cutoff_angle", Value(40.0), {}}});
  EXPECT_FLOAT_EQ(light->traits().power[0], plain->traits().power[0]);
}

/// Light that leaves the ball by emitted rays arrives on a plane as light that is asked for.
TEST(DistributedSpot, EmitsWhatItPromises) {
  for (const double cutoff : {20.0, 60.0}) {
    const auto light = make_distributed_spot(cutoff);
    Random random(7);
    RunningStatistics arriving, asked;
    const float side = cutoff > 30 ? 5.0f : 1.0f;  // of a square on the floor z = 0
    for (int i = 0; i < 1'000'000 / sample_share; ++i) {
      const Vec2f u = random.next_2d();
      const EmissionSample s = light->sample_emission(u, random.next_2d(), {});
      double flux = 0;
      if (s.direction.z < 0) {
        const Vec3f p = s.point.position + s.direction * (-s.point.position.z / s.direction.z);
        if (std::fabs(p.x - 1.5f) < side / 2 && std::fabs(p.y - 2) < side / 2) flux = s.flux[0];
      }
      arriving.add(flux);
    }
    for (int i = 0; i < 200'000 / sample_share; ++i) {
      const Vec2f u = random.next_2d();
      const Vec3f p(1.5f + side * (u.x - 0.5f), 2 + side * (u.y - 0.5f), 0);
      const LightSample s = light->sample_toward(p, random.next_2d());
      asked.add(s.pdf_solid_angle > 0
                    ? s.radiance[0] * s.direction.z * sqr(side) / s.pdf_solid_angle
                    : 0.0);
    }
    const double error = std::hypot(arriving.standard_error(), asked.standard_error());
    EXPECT_GT(z_test_p_value(arriving.mean(), error, asked.mean()), failure_level)
        << arriving.mean() << " " << asked.mean();
    if (twins_can_fail) {
      EXPECT_LT(error, 0.004 * asked.mean());
    }
    expect_twin_fails(z_test_p_value(1.03 * arriving.mean(), error, asked.mean()));
  }
}

TEST(DistributedLight, AttenuationIsForClassicalRayTracing) {
  const auto light = make_distributed({{"attenuation", Value(Vec3d(1, 0, 0)), {}}});
  EXPECT_FLOAT_EQ(light->traits().attenuation.factor(middle + Vec3f(0, 0, 3)), 9);
  EXPECT_FLOAT_EQ(make_distributed()->traits().attenuation.factor({0, 0, 0}), 1);
}

TEST(DistributedLight, RefusesContradictions) {
  const Value one(1.0), moved(Transform::translate({1, 0, 0}));
  EXPECT_THROW(make_distributed({{"power", one, {}}, {"intensity", one, {}}}), Error);
  EXPECT_THROW(make_distributed({{"to_world", moved, {}}}), Error);
  EXPECT_THROW(make_light("distributed", {{"radius", Value(0.0), {}}}), Error);
  EXPECT_THROW(make_distributed_spot(0), Error);
}

}  // namespace
}  // namespace kaustik
