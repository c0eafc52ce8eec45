// Where the sun stands, and how much light it and the sky give, against what was measured.

#include <gtest/gtest.h>

#include "kaustik/base/color.h"
#include "kaustik/base/daylight_units.h"
#include "kaustik/base/warp.h"
#include "kaustik/image/photometry.h"
#include "kaustik/light/clear_sky.h"
#include "kaustik/light/sun_position.h"
#include "kaustik/light/sunsky_light.h"
#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

constexpr double degree = std::numbers::pi / 180;

Horizontal sun_at(const PlaceAndTime& at) { return horizontal(sun_direction_at(at)); }

TEST(SunPosition, AgreesWithTheReferenceAlgorithm) {
  // The example of Reda and Andreas, "Solar Position Algorithm", NREL/TP-560-34302: zenith angle
  // 50.11162°, azimuth 194.34024° (with refraction, here 0.016°).
  PlaceAndTime at;
  at.latitude = 39.742476;
  at.longitude = -105.1786;
  at.timezone = -7;
  at.year = 2003;
  at.month = 10;
  at.day = 17;
  at.hour = 12 + 30.0 / 60 + 30.0 / 3600;
  const Horizontal sun = sun_at(at);
  EXPECT_NEAR(sun.altitude, 90 - 50.11162 - 0.016, 0.02);
  EXPECT_NEAR(sun.azimuth, 194.34024, 0.02);
}

TEST(SunPosition, StandsOverTheTropicAtMidsummer) {
  PlaceAndTime at;
  at.latitude = 23.44;
  at.year = 2010;
  at.month = 6;
  at.day = 21;
  at.hour = 12 + 2.0 / 60;  // the clock is two minutes ahead of the sun on that day
  EXPECT_GT(sun_at(at).altitude, 89.8);
  at.hour = 0;
  EXPECT_LT(sun_at(at).altitude, -40);
  // East in the morning, west in the evening.
  at.hour = 8;
  EXPECT_LT(sun_at(at).azimuth, 180);
  at.hour = 16;
  EXPECT_GT(sun_at(at).azimuth, 180);
}

TEST(SunPosition, IsToldOnTheGround) {
  // The morning of docs/guides/interior.md. At the solstice the declination is 23.44° and the clock
  // 1.8 minutes ahead of the sun, so the hour angle is -62.05°.
  const double latitude = 52.52 * degree, declination = 23.44 * degree, hour = -62.05 * degree;
  const double altitude = std::asin(std::sin(latitude) * std::sin(declination) +
                                    std::cos(latitude) * std::cos(declination) * std::cos(hour));
  const double east = -std::cos(declination) * std::sin(hour) / std::cos(altitude);
  const Horizontal berlin = sun_at({52.52, 13.40, 2, 2026, 6, 21, 9});
  EXPECT_NEAR(berlin.altitude, altitude / degree, 0.05);
  EXPECT_NEAR(berlin.azimuth, 180 - std::asin(east) / degree, 0.2);
  // The horizon, all around.
  const auto azimuth = [](double x, double y) { return horizontal({x, y, 0}).azimuth; };
  EXPECT_NEAR(azimuth(-1, 0), 0, 1e-9);
  EXPECT_NEAR(azimuth(0, -1), 90, 1e-9);
  EXPECT_NEAR(azimuth(1, 0), 180, 1e-9);
  EXPECT_NEAR(azimuth(0, 1), 270, 1e-9);
}

TEST(SunPlace, IsThatOfTheDayInTheWorld) {
  const auto placed = [](const std::vector<Property>& more) {
    std::vector<Property> all = {
        {"latitude", Value(52.52), {}},   {"longitude", Value(13.40), {}},
        {"timezone", Value(2.0), {}},     {"year", Value(int64_t(2026)), {}},
        {"month", Value(int64_t(6)), {}}, {"day", Value(int64_t(21)), {}},
        {"hour", Value(9.0), {}}};
    all.insert(all.end(), more.begin(), more.end());
    return sun_place(*make_light("sunsky", all)).value();
  };
  const Vec3d expected = sun_direction_at({52.52, 13.40, 2, 2026, 6, 21, 9});
  EXPECT_LT((placed({}).by_compass - expected).length(), 1e-6);
  EXPECT_LT(length(placed({}).in_world - Vec3f(expected)), 1e-6f);
  // East is +y after half a turn about the zenith.
  const SunPlace turned = placed({{"to_world", Value(Transform::rotate({0, 0, 1}, 180)), {}}});
  EXPECT_LT((turned.by_compass - expected).length(), 1e-6);
  EXPECT_NEAR(turned.in_world.y, -expected.y, 1e-6);
  EXPECT_GT(turned.in_world.y, 0.7f);
  EXPECT_FALSE(sun_place(*make_light("constant", {})));
}

TEST(SunPosition, KnowsTheCalendar) {
  EXPECT_TRUE(is_date(2012, 2, 29));
  EXPECT_FALSE(is_date(2011, 2, 29));
}

std::unique_ptr<Light> make_day(const std::string& type, double elevation, double turbidity = 3) {
  const Vec3d to_sun(std::cos(elevation * degree), 0, std::sin(elevation * degree));
  return make_light(type,
                    {{"turbidity", Value(turbidity), {}}, {"sun_direction", Value(to_sun), {}}});
}

/// lx on the ground, or on a surface that faces the sun.
RunningStatistics illuminance(const Light& light, const Vec3f& normal) {
  RunningStatistics result;
  Random random(17);
  for (int i = 0; i < 100'000; ++i) {
    const LightSample s = light.sample_toward(Vec3f(0, 0, 0), random.next_2d());
    if (!(s.pdf_solid_angle > 0)) continue;
    const Vec3f rgb(s.radiance[0], s.radiance[1], s.radiance[2]);
    result.add(luminance(rgb) * std::max(dot(s.direction, normal), 0.0f) / s.pdf_solid_angle);
  }
  return result;
}

Vec3f toward_sun(double elevation) {
  return {float(std::cos(elevation * degree)), 0, float(std::sin(elevation * degree))};
}

/// The IES's clear sky (Lighting Handbook, 8th ed., ch. 8; IES RP-21): sun 127.5 klx outside of the
/// air, weakened by exp(−0.21 m), m = 1/sin h; sky 0.8 + 15.5 √(sin h) klx on the ground.
double ies_sun(double sine) { return 127.5e3 * std::exp(-0.21 / sine); }
double ies_sky(double sine) { return 0.8e3 + 15.5e3 * std::sqrt(sine); }

TEST(SunSky, GivesTheLightOfAVeryClearDay) {
  for (const double elevation : {20.0, 40.0, 60.0, 80.0}) {
    SCOPED_TRACE(elevation);
    const double sine = std::sin(elevation * degree);
    const double sun = illuminance(*make_day("sun", elevation, 2), toward_sun(elevation)).mean();
    EXPECT_NEAR(sun, ies_sun(sine), 0.08 * ies_sun(sine));
    const double sky = illuminance(*make_day("sky", elevation, 2), {0, 0, 1}).mean();
    EXPECT_NEAR(sky, ies_sky(sine), 0.2 * ies_sky(sine));
  }
}

/// Measured on clear days in temperate climates with the sun high: 80 to 100 klx of sun on a
/// surface that faces it, 10 to 20 klx of sky on the ground.
TEST(SunSky, GivesTheLightOfAClearDay) {
  for (const double elevation : {45.0, 55.0, 65.0}) {
    SCOPED_TRACE(elevation);
    const double sun = illuminance(*make_day("sun", elevation, 2.5), toward_sun(elevation)).mean();
    EXPECT_GT(sun, 80e3);
    EXPECT_LT(sun, 100e3);
    const double sky = illuminance(*make_day("sky", elevation, 2.5), {0, 0, 1}).mean();
    EXPECT_GT(sky, 10e3);
    EXPECT_LT(sky, 20e3);
  }
}

// Radiance per nanometre that is the same at all wavelengths is 1 in Mitsuba: a mean.
TEST(SunSky, UnitsOfMitsuba) {
  double integral = 0;
  for (int nm = 360; nm <= 830; ++nm) integral += cie_xyz_at(nm).y;
  // 1 W/(sr·m²·nm) is so many W/(sr·m²) of 179 lm/W.
  EXPECT_NEAR(integral * 683 / 179 * mitsuba_daylight, 1, 2e-3);

  const Vec3d to_sun(std::cos(40 * degree), 0, std::sin(40 * degree));
  const auto day = [&](const std::string& units) {
    return make_light("sunsky",
                      {{"units", Value(units), {}}, {"sun_direction", Value(to_sun), {}}});
  };
  const auto physical = day("physical"), mitsuba = day("mitsuba"),
             usual = make_light("sunsky", {{"sun_direction", Value(to_sun), {}}});
  for (const Vec3f& d : {Vec3f(to_sun), Vec3f(0, 0, 1), normalize(Vec3f(-1, 2, 1))}) {
    const Spectrum whole = physical->distant().background(d, {});
    const Spectrum part = mitsuba->distant().background(d, {});
    EXPECT_EQ(usual->distant().background(d, {}), whole);
    for (int lane = 0; lane < 3; ++lane)
      EXPECT_NEAR(part[lane] * 683 * 106.857 / 179, whole[lane], 1e-5 * whole[lane]);
  }
}

TEST(SunSky, IsTheSumOfItsParts) {
  const auto both = make_day("sunsky", 40), sun = make_day("sun", 40), sky = make_day("sky", 40);
  Random random(5);
  for (int i = 0; i < 20'000; ++i) {
    const Vec3f d = i % 2 == 0 ? square_to_sphere(random.next_2d())
                               : sun->sample_toward(Vec3f(0, 0, 0), random.next_2d()).direction;
    ASSERT_EQ(both->distant().background(d, {}),
              sky->distant().background(d, {}) + sun->distant().background(d, {}));
  }
  const RunningStatistics whole = illuminance(*both, {0, 0, 1}),
                          of_sun = illuminance(*sun, {0, 0, 1}),
                          of_sky = illuminance(*sky, {0, 0, 1});
  const double parts = of_sun.mean() + of_sky.mean();
  const double error = std::hypot(whole.standard_error(),
                                  std::hypot(of_sun.standard_error(), of_sky.standard_error()));
  EXPECT_LT(error, 0.01 * parts);
  EXPECT_GT(z_test_p_value(whole.mean() - parts, error, 0), 0.001);
  EXPECT_NEAR(both->traits().power[1], sun->traits().power[1] + sky->traits().power[1],
              1e-4 * both->traits().power[1]);
}

TEST(SunSky, LightOfTheSkyIsWhatTheModelLeavesOver) {
  const double elevation = 50, sine = std::sin(elevation * degree);
  const Daylight day = daylight(4, sine);
  const Vec3d to_sun(std::cos(elevation * degree), 0, sine);
  const auto sky_over = [&](double albedo) {
    return make_light("sky", {{"turbidity", Value(4.0), {}},
                              {"albedo", Value(albedo), {}},
                              {"sun_direction", Value(to_sun), {}}});
  };
  const auto check = [&](double albedo) {
    const double sun = luminance(Vec3f(day.sun_rgb)) * sine;
    const double expected = (sun + day.sky_illuminance) / (1 - albedo * day.sky_albedo) - sun;
    const RunningStatistics measured = illuminance(*sky_over(albedo), {0, 0, 1});
    EXPECT_GT(z_test_p_value(measured, expected), failure_level)
        << measured.mean() << " not " << expected;
    if (twins_can_fail) {
      EXPECT_LT(measured.standard_error(), 0.003 * expected);
      expect_twin_fails(z_test_p_value(measured, 1.02 * expected));
    }
  };
  check(0);
  check(0.8);
}

TEST(SunSky, TheSunIsADiskOfHalfADegree) {
  const auto sun = make_day("sun", 40);
  const Frame frame(toward_sun(40));
  const auto at = [&](double degrees) {
    return frame.to_world(
        {float(std::sin(degrees * degree)), 0, float(std::cos(degrees * degree))});
  };
  EXPECT_GT(sun->distant().background(at(0.26), {})[1], 0);
  EXPECT_EQ(sun->distant().background(at(0.28), {})[1], 0);
  // A wider sun gives the same light.
  const auto wide = make_light("sun", {{"sun_direction", Value(Vec3d(toward_sun(40))), {}},
                                       {"sun_aperture", Value(30.0), {}}});
  const double expected = illuminance(*sun, toward_sun(40)).mean();
  EXPECT_NEAR(illuminance(*wide, toward_sun(40)).mean(), expected, 0.003 * expected);
}

TEST(SunSky, IsRedAtSunsetAndBlueAbove) {
  const Spectrum evening = make_day("sun", 4)->traits().power,
                 noon = make_day("sun", 60)->traits().power;
  EXPECT_GT(evening[0] / evening[2], 2 * noon[0] / noon[2]);
  const Spectrum zenith = make_day("sky", 40)->distant().background({0, 0, 1}, {});
  EXPECT_GT(zenith[2], 1.3f * zenith[0]);
  EXPECT_TRUE(make_day("sunsky", 40)->distant().background({0, 0.6f, -0.8f}, {}).is_zero());
}

TEST(SunSky, IsPositiveForAllParameters) {
  Random random(3);
  for (const double turbidity : {1.0, 1.5, 2.0, 3.0, 6.0, 10.0})
    for (const double elevation : {0.1, 5.0, 45.0, 90.0}) {
      const auto sky = make_day("sky", elevation, turbidity);
      ASSERT_GT(sky->traits().power[1], 0);
      for (int i = 0; i < 2000; ++i) {
        Vec3f d = square_to_sphere(random.next_2d());
        d.z = std::fabs(d.z);
        const Spectrum radiance = sky->distant().background(d, {});
        ASSERT_TRUE(radiance.is_finite());
        ASSERT_GT(radiance[1], 0);
      }
    }
}

/// Without haze more of the sun arrives, and less of the sky.
TEST(SunSky, MayHaveNoHazeAtAll) {
  const auto power = [](const std::string& type, double turbidity) {
    return double(make_day(type, 45, turbidity)->traits().power[1]);
  };
  for (const double turbidity : {1.0, 1.5}) {
    EXPECT_GT(power("sun", turbidity), power("sun", turbidity + 0.5));
    EXPECT_LT(power("sky", turbidity), power("sky", turbidity + 0.5));
  }
  // Of green light the aerosols of turbidity 2 take what exp(−0.0461 · 0.55^−1.3 · 1.41) leaves.
  EXPECT_NEAR(power("sun", 1) / power("sun", 2), 1 / std::exp(-0.0461 * 2.175 * 1.412), 0.02);
}

TEST(SunSky, StandsInTheFrameOfToWorld) {
  // The emitter's zenith becomes the world's +y.
  const Value turned(Transform::rotate({1, 0, 0}, -90));
  const auto light = make_light(
      "sunsky", {{"to_world", turned, {}}, {"sun_direction", Value(Vec3d(0, 1, 0.5)), {}}});
  EXPECT_GT(light->distant().background(normalize(Vec3f(0, 1, 0.5f)), {})[1], 1000);
  EXPECT_TRUE(light->distant().background(normalize(Vec3f(0.5f, -0.1f, 0.5f)), {}).is_zero());
  // By place and time: Tokyo in the afternoon, the sun in the west (+y), as high as it was then.
  const auto tokyo = make_light("sun", {});
  const Vec3f to_sun = tokyo->sample_toward(Vec3f(0, 0, 0), {0.5f, 0.5f}).direction;
  EXPECT_GT(to_sun.y, 0.5f);
  EXPECT_NEAR(std::asin(to_sun.z) / degree, 47, 1.5);
}

void expect_error(const std::vector<Property>& properties, const std::string& part) {
  try {
    make_light("sunsky", properties);
    ADD_FAILURE() << "no error: " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(SunSky, RefusesWhatCannotBe) {
  const Value up(Vec3d(0, 0, 1));
  expect_error({{"hour", Value(1.0), {}}}, "below the horizon");
  expect_error({{"sun_direction", Value(Vec3d(0, 1, -0.1)), {}}}, "below the horizon");
  expect_error({{"sun_direction", Value(Vec3d(0, 0, 0)), {}}}, "zero");
  expect_error({{"sun_direction", up, {}}, {"hour", Value(1.0), {}}}, "both");
  expect_error({{"month", Value(int64_t(2)), {}}, {"day", Value(int64_t(30)), {}}}, "no day");
  expect_error({{"sun_direction", up, {}}, {"albedo", Value(1.5), {}}}, "albedo");
  expect_error({{"turbidity", Value(0.9), {}}}, "turbidity");
  expect_error({{"to_world", Value(Transform::scale({1, 2, 1})), {}}}, "distorts");
}

}  // namespace
}  // namespace kaustik
