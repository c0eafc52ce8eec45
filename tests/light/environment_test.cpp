// Light from a picture all around.

#include <gtest/gtest.h>

#include "kaustik/base/warp.h"
#include "kaustik/image/image_io.h"
#include "kaustik/light/latlong_distribution.h"
#include "tests/light/light_testing.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

/// Twelve columns, seven rows, each pixel with a value of its own.
std::vector<Rgb> numbered_pixels() {
  std::vector<Rgb> pixels;
  for (int i = 0; i < 84; ++i) pixels.push_back({1.0 + i, 0, 0});
  return pixels;
}

TEST(Envmap, StandsAsInMitsuba) {
  const auto light = make_envmap(12, 7, numbered_pixels());
  const auto red = [&](const Vec3f& direction) {
    return light->distant().background(direction, {})[0];
  };
  // The upper row is one direction, +y, and the lower one −y: what is seen there is a mean.
  EXPECT_NEAR(red({0, 1, 0}), 6.5, 5.51);
  EXPECT_NEAR(red({0, -1, 0}), 78.5, 5.51);
  // Column c stands at (c + 1/2)/12 of a turn from −z by +x; the equator is row 3.
  const auto at_turn = [&](double turn) {
    const double phi = 2 * std::numbers::pi * turn;
    return red({float(std::sin(phi)), 0, float(-std::cos(phi))});
  };
  for (int column = 0; column < 12; ++column)
    EXPECT_NEAR(at_turn((column + 0.5) / 12), 1 + 36 + column, 1e-3);
  EXPECT_NEAR(red({1, 0, 0}), 1 + 36 + 2.5, 1e-3);        // between columns 2 and 3
  EXPECT_NEAR(red({0, 0, 1}), 1 + 36 + 5.5, 1e-3);        // the middle
  EXPECT_NEAR(red({0, 0, -1}), 1 + 36 + 0.5 * 11, 1e-3);  // the border: columns 11 and 0
  // Row 2 stands 60° from +y.
  const float s = std::sin(pi / 3);
  EXPECT_NEAR(red({0, 0.5f, s}), 1 + 24 + 5.5, 1e-3);
}

TEST(Envmap, IsTurnedByToWorld) {
  const Value turned(Transform::rotate({1, 0, 0}, 90));  // its +y becomes +z
  const auto light = make_envmap(12, 7, numbered_pixels(), {{"to_world", turned, {}}});
  EXPECT_LT(light->distant().background({0, 0, 1}, {})[0], 13);
  EXPECT_GT(light->distant().background({0, 0, -1}, {})[0], 72);
}

TEST(Envmap, OfOneColorIsConstant) {
  const std::vector<Rgb> pixels(32 * 16, Rgb{1, 2, 3});
  const auto light = make_envmap(32, 16, pixels, {{"scale", Value(0.5), {}}});
  const auto constant = make_light("constant", {{"radiance", Value(Rgb{0.5, 1, 1.5}), {}}});
  for (int lane = 0; lane < 3; ++lane)
    EXPECT_NEAR(light->traits().power[lane], constant->traits().power[lane],
                1e-4 * light->traits().power[lane]);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const LightSample s = light->sample_toward(Vec3f(0, 0, 0), random.next_2d());
    EXPECT_NEAR(s.pdf_solid_angle, 0.25 * inv_pi, 1e-5);
    EXPECT_NEAR(s.radiance[1], 1, 1e-6);
    EXPECT_NEAR(light->expected_irradiance({{0, 0, 0}, s.direction}),
                constant->expected_irradiance({{0, 0, 0}, s.direction}), 0.1);
  }
}

struct EnvironmentCase {
  std::string name;
  std::shared_ptr<const Light> light;
};
std::vector<EnvironmentCase> environments() {
  const Value turned(Transform::rotate({1, 2, 3}, 50));
  const Value toward(Vec3d(1, 2, 3));
  std::vector<Rgb> lamp(32 * 16, Rgb{0, 0, 0});
  lamp[5 * 32 + 20] = {1, 1, 1};  // one pixel shines
  std::vector<EnvironmentCase> cases;
  cases.push_back({"spots", make_envmap(9, 5, spotted_pixels(45), {{"to_world", turned, {}}})});
  cases.push_back({"one column", make_envmap(1, 6, spotted_pixels(6))});
  cases.push_back({"one row", make_envmap(7, 1, spotted_pixels(7))});
  cases.push_back({"one pixel", make_envmap(1, 1, {{1, 1, 1}})});
  cases.push_back({"two rows", make_envmap(4, 2, spotted_pixels(8))});
  cases.push_back({"lamp", make_envmap(32, 16, lamp)});
  cases.push_back({"sky", make_light("sky", {{"sun_direction", toward, {}}})});
  cases.push_back({"wide sun", make_light("sun", {{"sun_direction", Value(Vec3d(0.2, 0.1, 1)), {}},
                                                  {"sun_aperture", Value(80.0), {}}})});
  return cases;
}

/// Of what receives the light: anything, and surfaces.
const Vec3f receiving_normals[] = {{0, 0, 0}, {0, 0, 1}, normalize({0.5f, -0.7f, -0.2f})};

TEST(Environment, DirectionsFollowTheirDensity) {
  for (const EnvironmentCase& test : environments())
    for (const Vec3f& normal : receiving_normals) {
      SCOPED_TRACE(test.name);
      Random random(23);
      const LightQuery query(Vec3f(0, 0, 0), normal);
      const auto sample = [&] {
        return test.light->sample_toward(query, random.next_2d()).direction;
      };
      const auto pdf = [&](const Vec3f& d) { return double(test.light->pdf_toward(query, d)); };
      const int count = 500'000 / sample_share;
      EXPECT_GT(direction_p_value({}, count, sample, pdf), failure_level);
      expect_twin_fails(
          [&] { return direction_p_value({}, count, sample, with_planted_error({}, pdf)); });
    }
}

TEST(Environment, ReportsTheDensityThatItAnswersLater) {
  for (const EnvironmentCase& test : environments())
    for (const Vec3f& normal : receiving_normals) {
      SCOPED_TRACE(test.name);
      Random random(5);
      const LightQuery query(Vec3f(1, 2, 3), normal);
      for (int i = 0; i < 2000; ++i) {
        const LightSample s = test.light->sample_toward(query, random.next_2d());
        ASSERT_NEAR(length(s.direction), 1, 1e-5);
        ASSERT_NEAR(s.pdf_solid_angle, test.light->pdf_toward(query, s.direction),
                    1e-5f * s.pdf_solid_angle);
        ASSERT_EQ(s.radiance, test.light->distant().background(s.direction, {}));
        ASSERT_EQ(s.distance, infinity);
      }
    }
}

/// Where there is light, it may be sampled.
TEST(Environment, NoLightIsOutOfReach) {
  for (const EnvironmentCase& test : environments()) {
    SCOPED_TRACE(test.name);
    Random random(7);
    for (int i = 0; i < 20'000; ++i) {
      const Vec3f d = square_to_sphere(random.next_2d());
      if (test.light->distant().background(d, {}).is_zero()) continue;
      for (const Vec3f& normal : receiving_normals) {
        if (dot(normal, d) < 0) continue;
        ASSERT_GT(test.light->pdf_toward({Vec3f(0, 0, 0), normal}, d), 0);
      }
      ASSERT_GT(test.light->emission_pdf_direction({}, -d), 0);
    }
  }
}

/// What uniform directions find is what sampling finds, with far less noise.
TEST(Environment, SamplingFindsAllTheLight) {
  for (const EnvironmentCase& test : environments()) {
    SCOPED_TRACE(test.name);
    Random random(9);
    RunningStatistics sampled, uniform;
    for (int i = 0; i < 400'000 / sample_share; ++i) {
      const LightSample s = test.light->sample_toward(Vec3f(0, 0, 0), random.next_2d());
      sampled.add(s.pdf_solid_angle > 0 ? s.radiance[1] / s.pdf_solid_angle : 0.0);
      uniform.add(test.light->distant().background(square_to_sphere(random.next_2d()), {})[1] /
                  sphere_pdf);
    }
    const double fluence = test.light->traits().power[1] / (pi * 12.0);  // of the test's bounds
    EXPECT_LT(sampled.variance(), 0.4 * uniform.variance() + 1e-6 * fluence * fluence);
    if (uniform.standard_error() > 1e-5 * fluence) {
      EXPECT_GT(z_test_p_value(uniform, fluence), failure_level);
    }
    if (sampled.standard_error() > 1e-5 * fluence) {
      EXPECT_GT(z_test_p_value(sampled, fluence), failure_level);
      expect_twin_fails(z_test_p_value(sampled, 1.02 * fluence));
    } else {
      EXPECT_NEAR(sampled.mean(), fluence, 1e-4 * fluence);
    }
    if (twins_can_fail) {
      EXPECT_LT(sampled.standard_error(), 0.003 * fluence);
    }
  }
}

/// The harmonics against the integral, for surfaces of any orientation.
TEST(Environment, ExpectedIrradianceIsNearTheIntegral) {
  for (const EnvironmentCase& test : environments()) {
    SCOPED_TRACE(test.name);
    Random random(11);
    const double mean = 0.25 * test.light->traits().power.sum() / (pi * 12.0);
    for (int k = 0; k < 20; ++k) {
      const LightQuery query({0, 0, 0}, square_to_sphere(random.next_2d()));
      double irradiance = 0;
      const int count = 4000;
      for (int i = 0; i < count; ++i) {
        const LightSample s = test.light->sample_toward(query, random.next_2d());
        irradiance += s.radiance.sum() / s.pdf_solid_angle / count *
                      std::max(dot(s.direction, query.normal), 0.0f);
      }
      EXPECT_NEAR(test.light->expected_irradiance(query), irradiance, 0.6 * mean);
    }
  }
}

void expect_error(const std::function<void()>& make, const std::string& part) {
  try {
    make();
    ADD_FAILURE() << "no error: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Envmap, RepairsBadPixels) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto right = make_envmap(2, 1, {{1, 1, 1}, {0, 0, 0}});
  for (const Rgb& bad : {Rgb{nan, 0, 0}, Rgb{0, -1, 0}}) {
    const auto light = make_envmap(2, 1, {{1, 1, 1}, bad});
    EXPECT_EQ(light->traits().power.sum(), right->traits().power.sum());
  }
}

TEST(Envmap, RefusesBadPictures) {
  expect_error([] { make_envmap(2, 2, std::vector<Rgb>(4)); }, "black");
  expect_error([] { make_light("envmap", {}); }, "filename");
  expect_error(
      [] {
        make_light("envmap", {{"filename", Value(std::string("/none.exr")), {}}});
      },
      "/none.exr");
  expect_error([] { make_envmap(1, 1, {{1, 1, 1}}, {{"scale", Value(-1.0), {}}}); }, "scale");
  const Value sheared(Transform::scale({1, 2, 1}));
  expect_error([&] { make_envmap(1, 1, {{1, 1, 1}}, {{"to_world", sheared, {}}}); }, "distorts");
  expect_error([] { make_envmap(1, 1, {{1e38, 1e38, 1e38}}); }, "overflows");
}

TEST(Envmap, RefusesATruncatedPicture) {
  const test::TemporaryFolder folder;
  const std::string whole = folder.path("whole.exr"), cut = folder.path("cut.exr");
  Image image(8, 4, {"R", "G", "B"});
  image.channel(0)[3] = 1;
  write_image(image, whole);
  std::filesystem::copy_file(whole, cut);
  std::filesystem::resize_file(cut, std::filesystem::file_size(whole) / 2);
  expect_error([&] { make_light("envmap", {{"filename", Value(cut), {}}}); }, "cut.exr");
}

TEST(Envmap, WithoutScaleIsNoLight) {
  const auto dark =
      make_envmap(2, 2, std::vector<Rgb>(4, Rgb{1, 1, 1}), {{"scale", Value(0.0), {}}});
  EXPECT_TRUE(dark->traits().power.is_zero());
  EXPECT_EQ(dark->expected_irradiance(Vec3f(0, 0, 0)), 0);
}

TEST(LatLongDistribution, OfNothingHasNoDensity) {
  const LatLongDistribution nothing(3, std::vector<float>(6, 0.0f), std::numbers::pi);
  EXPECT_EQ(nothing.integral(), 0);
  EXPECT_EQ(nothing.pdf({0.2, 0.1}), 0);
}

TEST(Background, IsSeenAndNothingElse) {
  const auto light = make_light("background", {{"radiance", Value(3.0), {}}});
  EXPECT_TRUE(light->traits().is_only_seen);
  EXPECT_FLOAT_EQ(light->distant().background({0, 0, 1}, {})[0], 3);
  EXPECT_TRUE(light->traits().power.is_zero());
  EXPECT_EQ(light->expected_irradiance(Vec3f(0, 0, 0)), 0);
  EXPECT_EQ(light->sample_toward(Vec3f(0, 0, 0), {0.5f, 0.5f}).pdf_solid_angle, 0);
  EXPECT_TRUE(light->sample_emission({0.5f, 0.5f}, {0.5f, 0.5f}, {}).flux.is_zero());
}

}  // namespace
}  // namespace kaustik
