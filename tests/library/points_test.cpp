// Estimates at points and along rays, for hosts: closed forms, and what is refused.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rooms.h"

namespace kaustik::library_test {
namespace {

constexpr double intensity = 3, reflectance = 0.4;

/// A matt floor, z = 0, and a point lamp 1 m above the origin; no camera.
Scene lit_floor(const std::vector<Object>& more = {}) {
  std::vector<Object> objects = {
      Object("emitter", "point", "lamp").set("position", Vec3{0, 0, 1}).set("intensity", intensity),
      square_mesh()
          .shape("floor")
          .set("to_world", Transform::scale({4, 4, 4}))
          .add(Object("bsdf", "diffuse").set("reflectance", reflectance))};
  objects.insert(objects.end(), more.begin(), more.end());
  return Scene(objects);
}

double from_lamp(const Vec3& at) {
  const double up = 1 - at.z;
  return intensity * up / std::pow(at.x * at.x + at.y * at.y + up * up, 1.5);
}

TEST(LibraryPoints, IrradianceUnderALamp) {
  const std::vector<Vec3> points = {{0.5, 0.2, 0}, {0.5, 0.2, 0.6}, {0, 0, 1.5}};
  const Vec3 up[] = {{0, 0, 2}};
  const Estimates measured = irradiance(lit_floor(), points, up, passes(4, 8));
  ASSERT_EQ(measured.luminance.size(), 3u);
  EXPECT_EQ(measured.picture.width(), 3);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(measured.luminance[i].value / from_lamp(points[i]), 1, 1e-4) << i;
    EXPECT_NEAR(measured.rgb[i].g / from_lamp(points[i]), 1, 1e-4) << i;
  }
  EXPECT_EQ(measured.luminance[2].value, 0);
}

// π L; half of it where a wall stands on one side would be far outside of the interval.
TEST(LibraryPoints, IrradianceUnderASky) {
  const Scene scene({Object("emitter", "constant", "sky").set("radiance", 1)});
  const Vec3 point[] = {{0, 0, 0}}, normal[] = {{1, 2, 3}};
  const Estimates measured = irradiance(scene, point, normal);
  EXPECT_EQ(measured.picture.passes(), 16u);
  const Interval interval = measured.luminance[0].interval(0.9999);
  EXPECT_LE(interval.low - 1e-5, std::numbers::pi);
  EXPECT_GE(interval.high + 1e-5, std::numbers::pi);
  EXPECT_LT(interval.high - interval.low, 0.1);
}

TEST(LibraryPoints, RadianceAlongRays) {
  const Vec3 origin[] = {{0.3, -0.2, 2}};
  const std::vector<Vec3> directions = {{0, 0, -3}, {0, 0, 1}};
  // The scene's own camera does not count.
  const Estimates measured = radiance(lit_floor({camera(8, 8)}), origin, directions, passes(2, 4));
  ASSERT_EQ(measured.luminance.size(), 2u);
  EXPECT_NEAR(
      measured.luminance[0].value / (reflectance / std::numbers::pi * from_lamp({0.3, -0.2, 0})), 1,
      1e-3);
  EXPECT_EQ(measured.luminance[1].value, 0);
}

TEST(LibraryPoints, WhatIsRefused) {
  const std::vector<Vec3> two = {{0, 0, 0}, {0, 0, 1}}, three(3, Vec3{0, 0, 1}), none;
  const std::vector<Vec3> nowhere = {{0, 0, 0}}, nan = {{0, std::nan(""), 0}};
  const Scene scene = lit_floor();
  const auto place_of = [&](const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                            const SessionSettings& settings = passes(1, 1)) {
    return error_of([&] { irradiance(scene, points, normals, settings); }).file();
  };
  EXPECT_EQ(place_of(none, none), "points");
  EXPECT_EQ(place_of(none, two), "points");
  EXPECT_EQ(place_of(two, none), "normals");
  EXPECT_EQ(place_of(two, three), "normals");
  EXPECT_EQ(place_of(two, nowhere), "normals");
  EXPECT_EQ(place_of(nan, nowhere), "points");
  SessionSettings settings = passes(1, 1);
  settings.camera = "mine";
  EXPECT_EQ(error_of([&] { radiance(scene, two, three, settings); }).kind(), ErrorKind::input);
}

// The error names the setting, and who does know them.
TEST(LibraryPoints, IntegratorsThatKnowNoPoints) {
  const std::vector<Vec3> point = {{0, 0, 0.5}}, up = {{0, 0, 1}};
  SessionSettings settings = passes(1, 1);
  settings.integrator = "lighttracer";
  const Error error = error_of([&] { irradiance(lit_floor(), point, up, settings); });
  EXPECT_EQ(error.file(), "SessionSettings::integrator");
  EXPECT_NE(error.remedy().find("vcm"), std::string::npos) << error.what();
}

}  // namespace
}  // namespace kaustik::library_test
