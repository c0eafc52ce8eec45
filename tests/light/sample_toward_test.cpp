// Light found from a point: densities, closed forms of irradiance, sides.

#include <gtest/gtest.h>

#include "kaustik/geometry/ray_tracer.h"
#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

const Vec3f reference(0.2f, -0.1f, 0.0f);

std::unique_ptr<Light> area_light(std::shared_ptr<const Shape> shape, double radiance = 2) {
  return make_light("area", {{"radiance", Value(radiance), {}}}, std::move(shape));
}

/// Density of sample_toward in a direction, by way of the point that is hit there.
double density_toward(const Light& light, const RayTracer& tracer, const Vec3f& direction) {
  const Ray ray{reference, direction};
  Hit hit;
  if (!tracer.intersect(ray, hit)) return 0;
  return light.pdf_toward(reference, tracer.surface_point(ray, hit));
}

struct ShapeCase {
  std::string name;
  std::shared_ptr<const Shape> shape;
  float one_minus_cos;  ///< of a cone about the shape's centre that holds it
};

/// Shapes around the reference, that hide no shining part of their own from it and whose density is
/// bounded (that of a cylinder seen from outside is not, at its outline).
std::vector<ShapeCase> shapes_around() {
  const Vec3f ball(0.3f, 0.4f, 2);
  // The ball's rim lies on a border of the grid, so that its integral is sharp.
  const float cap = 1.0f - safe_sqrt(1.0f - sqr(0.7f) / length_sq(ball - reference));
  const Value placed(Transform::translate({0.5, 0.2, 2}) * Transform::rotate({1, 2, 3}, 40) *
                     Transform::scale({0.4, 0.4, 0.4}));
  const Value flipped(true);
  return {
      {"quad", make_quad({-1, -1, 2}, {0.3f, 2, 0.5f}, {2, 0, 0}), 0.7f},
      {"disk", make_disk({0.5f, 0, 1.5f}, normalize(Vec3f(0.3f, 0.2f, -1)), 0.8f), 0.3f},
      {"sphere", make_ball(ball, 0.7f), 1.2f * cap},
      {"sphere from inside",
       make_shape("sphere", {{"radius", Value(2.0), {}}, {"flip_normals", flipped, {}}}), 2},
      {"ellipsoid from inside",
       make_shape("sphere",
                  {{"flip_normals", flipped, {}},
                   {"to_world",
                    Value(Transform::rotate({1, 2, 3}, 40) * Transform::scale({1.5, 2.0, 1.2})),
                    {}}}),
       2},
      {"cube", make_shape("cube", {{"to_world", placed, {}}}), 0.2f},
      {"cylinder from inside",
       make_shape("cylinder", {{"p0", Value(Vec3d(0, 0, -1)), {}}, {"flip_normals", flipped, {}}}),
       2}};
}

TEST(SampleToward, AreaLightsFollowTheirDensity) {
  for (const ShapeCase& test : shapes_around()) {
    SCOPED_TRACE(test.name);
    const auto light = area_light(test.shape);
    const RayTracer tracer({{test.shape}, {}, {}});
    DirectionGrid grid;
    const Vec3f to_shape = center(test.shape->bounds()) - reference;
    if (test.one_minus_cos < 2) grid.axis = normalize(to_shape);
    grid.one_minus_cos = test.one_minus_cos;
    Random random(11);
    const auto sample = [&] {
      const LightSample s = light->sample_toward(reference, random.next_2d());
      return s.pdf_solid_angle > 0 ? s.direction : Vec3f(0, 0, 0);
    };
    const auto pdf = [&](const Vec3f& d) { return density_toward(*light, tracer, d); };
    const int count = 1'000'000 / sample_share;
    EXPECT_GT(direction_p_value(grid, count, sample, pdf), failure_level);
    expect_twin_fails(
        [&] { return direction_p_value(grid, count, sample, with_planted_error(grid, pdf)); });
  }
}

/// From so near that samples by area would be worth from nothing to very much: closed forms of
/// irradiance below the middle of a disk (π L sin²), of a square (Lambert's polygon formula) and of
/// a spheroid, of whose outline the cone has the tangent a / √(d² − c²).
TEST(SampleToward, NearLightsGiveTheirClosedForm) {
  struct Case {
    std::string name;
    std::shared_ptr<const Shape> shape;
    double irradiance;
  };
  const double h = 0.1;
  const double side = std::sqrt(1 + h * h);
  const Vec3f middle = reference + Vec3f(0, 0, float(h));
  for (const Case& test :
       {Case{"disk", make_disk(middle, {0, 0, -1}, 1), 2 * std::numbers::pi / (1 + h * h)},
        Case{"square", make_quad(middle - Vec3f(1, 1, 0), {0, 2, 0}, {2, 0, 0}),
             2 * 4 / side * std::atan(1 / side)},
        Case{
            "spheroid",
            make_shape("sphere", {{"to_world",
                                   Value(Transform::translate(Vec3d(reference) + Vec3d(0, 0, 1.5)) *
                                         Transform::scale({1.5, 1.5, 0.5})),
                                   {}}}),
            2 * std::numbers::pi * 2.25 / (2.25 - 0.25 + 2.25)}}) {
    SCOPED_TRACE(test.name);
    const auto light = area_light(test.shape);
    Random random(19);
    RunningStatistics irradiance;
    for (int i = 0; i < 100'000 / sample_share; ++i) {
      const LightSample s = light->sample_toward(reference, random.next_2d());
      irradiance.add(s.pdf_solid_angle > 0 ? s.radiance[0] * s.direction.z / s.pdf_solid_angle : 0);
      if (s.pdf_solid_angle > 0) {
        ASSERT_FLOAT_EQ(s.pdf_solid_angle, light->pdf_toward(reference, s.point));
      }
    }
    EXPECT_GT(z_test_p_value(irradiance, test.irradiance), failure_level);
    EXPECT_LT(std::sqrt(irradiance.variance()), 0.9 * test.irradiance);  // by area: several times
    expect_twin_fails(z_test_p_value(irradiance, 1.02 * test.irradiance));
  }
}

/// Within a shell that shines inward the irradiance is π L everywhere, whatever its form.
TEST(SampleToward, InsideOfAnEllipsoidItIsThatOfTheHemisphere) {
  const auto light = area_light(make_shape(
      "sphere", {{"flip_normals", Value(true), {}},
                 {"to_world",
                  Value(Transform::rotate({1, 2, 3}, 40) * Transform::scale({1.0, 0.6, 1.4})),
                  {}}}));
  Random random(20);
  RunningStatistics irradiance;
  for (int i = 0; i < 400'000 / sample_share; ++i) {
    const LightSample s = light->sample_toward(reference, random.next_2d());
    irradiance.add(s.pdf_solid_angle > 0
                       ? s.radiance[0] * std::max(0.0f, s.direction.z) / s.pdf_solid_angle
                       : 0);
  }
  EXPECT_GT(z_test_p_value(irradiance, 2 * std::numbers::pi), failure_level);
  expect_twin_fails(z_test_p_value(irradiance, 2 * std::numbers::pi * 1.02));
}

TEST(SampleToward, ReportsTheDensityThatItAnswersLater) {
  for (const ShapeCase& test : shapes_around()) {
    SCOPED_TRACE(test.name);
    const auto light = area_light(test.shape);
    EXPECT_EQ(light->traits().shape, 7);
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
      const LightSample s = light->sample_toward(reference, random.next_2d());
      ASSERT_TRUE(s.on_surface);
      EXPECT_EQ(s.point.shape, 7u);
      EXPECT_FLOAT_EQ(s.pdf_solid_angle, light->pdf_toward(reference, s.point));
      EXPECT_NEAR(length(reference + s.direction * s.distance - s.point.position), 0, 1e-5);
      EXPECT_EQ(s.radiance, light->emitted(s.point, -s.direction, {}));
    }
  }
}

TEST(SampleToward, TheEnvironmentIsUniform) {
  const auto light = make_light("constant", {{"radiance", Value(3.0), {}}});
  DirectionGrid grid;
  Random random(5);
  const auto sample = [&] { return light->sample_toward(reference, random.next_2d()).direction; };
  const auto pdf = [&](const Vec3f& d) { return double(light->pdf_toward(reference, d)); };
  const int count = 1'000'000 / sample_share;
  EXPECT_GT(direction_p_value(grid, count, sample, pdf), failure_level);
  expect_twin_fails(
      [&] { return direction_p_value(grid, count, sample, with_planted_error(grid, pdf)); });
  const LightSample s = light->sample_toward(reference, {0.3f, 0.6f});
  EXPECT_EQ(s.distance, infinity);
  EXPECT_FALSE(s.delta);
  EXPECT_EQ(s.radiance, light->distant().background(s.direction, {}));
}

/// Irradiance on a surface of normal +z at the origin of the tests.
RunningStatistics irradiance(const Light& light, const Vec3f& at, int count) {
  RunningStatistics statistics;
  Random random(17);
  for (int i = 0; i < count; ++i) {
    const LightSample s = light.sample_toward(at, random.next_2d());
    const double cosine = std::max(0.0f, s.direction.z);
    statistics.add(s.pdf_solid_angle > 0 ? cosine * s.radiance[1] / s.pdf_solid_angle : 0.0);
  }
  return statistics;
}

/// The estimate agrees with the closed form, is sharp, and would notice an error of 2 %.
void expect_irradiance(const Light& light, const Vec3f& at, double expected, int count = 400'000) {
  const RunningStatistics statistics = irradiance(light, at, count / sample_share);
  EXPECT_GT(z_test_p_value(statistics, expected), failure_level)
      << statistics.mean() << " ± " << statistics.standard_error() << ", not " << expected;
  if (!twins_can_fail) return;
  EXPECT_LT(statistics.standard_error(), 0.003 * expected);
  expect_twin_fails(z_test_p_value(statistics, 1.02 * expected));
}

TEST(Irradiance, OfADiskOnItsAxis) {
  const double a = 0.8, h = 1.3, radiance = 2;
  const auto light = area_light(make_disk({0, 0, 1.3f}, {0, 0, -1}, 0.8f), radiance);
  expect_irradiance(*light, {0, 0, 0}, std::numbers::pi * radiance * a * a / (a * a + h * h));
}

TEST(Irradiance, OfASphere) {
  const double r = 0.5, d = 2, radiance = 2;
  const auto light = area_light(make_ball({0, 0, 2}, 0.5f), radiance);
  expect_irradiance(*light, {0, 0, 0}, std::numbers::pi * radiance * r * r / (d * d));
}

TEST(Irradiance, OfAQuadOverItsCorner) {
  // Form factor of a parallel rectangle a × b at distance c, over a corner (Howell, B-3).
  const double a = 1.5, b = 0.7, c = 1.1;
  const auto light = area_light(make_quad({0, 0, 1.1f}, {0, 0.7f, 0}, {1.5f, 0, 0}));
  const double p = std::sqrt(a * a + c * c), q = std::sqrt(b * b + c * c);
  const double factor = (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / 2;
  expect_irradiance(*light, {0, 0, 0}, 2 * factor);
}

TEST(Irradiance, OfTheEnvironment) {
  const auto light = make_light("constant", {{"radiance", Value(3.0), {}}});
  expect_irradiance(*light, {0, 0, 0}, 3 * std::numbers::pi);
}

TEST(Irradiance, OfAPoint) {
  const auto light =
      make_light("point", {{"intensity", Value(5.0), {}}, {"position", Value(Vec3d(3, 0, 4)), {}}});
  const LightSample s = light->sample_toward(Vec3f(0, 0, 0), {0.5f, 0.5f});
  EXPECT_TRUE(s.delta && light->traits().is_delta);
  EXPECT_FLOAT_EQ(s.pdf_solid_angle, 1);
  EXPECT_FLOAT_EQ(s.distance, 5);
  EXPECT_FLOAT_EQ(s.radiance[0], 5.0f / 25);
  EXPECT_FLOAT_EQ(s.direction.x, 0.6f);
  EXPECT_FLOAT_EQ(s.direction.z, 0.8f);
  EXPECT_EQ(light->pdf_toward(Vec3f(0, 0, 0), s.point), 0);
}

TEST(Irradiance, OfADirection) {
  const auto light = make_light(
      "directional", {{"irradiance", Value(5.0), {}}, {"direction", Value(Vec3d(0, 3, -4)), {}}});
  const LightSample s = light->sample_toward(Vec3f(0, 0, 0), {0.5f, 0.5f});
  EXPECT_TRUE(s.delta && light->traits().is_delta && light->is_infinite());
  EXPECT_FLOAT_EQ(s.radiance[0], 5);
  EXPECT_NEAR(length(s.direction - Vec3f(0, -0.6f, 0.8f)), 0, 1e-6);
  EXPECT_EQ(s.distance, infinity);
}

TEST(AreaLight, ShinesOnTheSideOfTheNormalOnly) {
  const auto light = area_light(make_disk({0, 0, 1}, {0, 0, 1}, 0.5f));
  const LightSample behind = light->sample_toward(Vec3f(0, 0, 0), {0.3f, 0.3f});
  EXPECT_EQ(behind.pdf_solid_angle, 0);
  EXPECT_TRUE(behind.radiance.is_zero());
  EXPECT_EQ(light->pdf_toward(Vec3f(0, 0, 0), behind.point), 0);
  EXPECT_TRUE(light->emitted(behind.point, {0, 0, -1}, {}).is_zero());
  EXPECT_TRUE(light->emitted(behind.point, {1, 0, 0}, {}).is_zero());
  const LightSample before = light->sample_toward(Vec3f(0, 0, 2), {0.3f, 0.3f});
  EXPECT_GT(before.pdf_solid_angle, 0);
  EXPECT_FLOAT_EQ(before.radiance[2], 2);
}

TEST(SpotLight, FallsLinearlyWithTheAngle) {
  const Transform to_world = Transform::look_at({1, 2, 3}, {1, 2, 10}, {0, 1, 0});
  const auto light = make_light("spot", {{"intensity", Value(4.0), {}},
                                         {"cutoff_angle", Value(40.0), {}},
                                         {"beam_width", Value(10.0), {}},
                                         {"to_world", Value(to_world), {}}});
  const auto intensity_at = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3f at(1.0f + float(2 * std::sin(angle)), 2, 3.0f + float(2 * std::cos(angle)));
    return light->sample_toward(at, {0, 0}).radiance[0] * 4.0f;
  };
  EXPECT_FLOAT_EQ(intensity_at(0), 4);
  EXPECT_FLOAT_EQ(intensity_at(9.9), 4);
  EXPECT_NEAR(intensity_at(25), 2, 1e-4);
  EXPECT_NEAR(intensity_at(35), 4.0 * 5 / 30, 1e-4);
  EXPECT_EQ(intensity_at(40.1), 0);
  EXPECT_EQ(intensity_at(180), 0);
}

TEST(SpotLight, HasMitsubasDefaultBeam) {
  const auto light = make_light("spot", {{"cutoff_angle", Value(40.0), {}}});
  const float middle = 35 * pi / 180;  // halfway from 30 to 40
  const auto at = light->emitted({}, {std::sin(middle), 0, std::cos(middle)}, {});
  EXPECT_NEAR(at[0], 0.5f, 1e-5);
}

}  // namespace
}  // namespace kaustik
