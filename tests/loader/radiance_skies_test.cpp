// Light from all around: sources, gensky and gendaylit, by their irradiance in closed form.
#include "radiance_support.h"

namespace kaustik::radiance_test {
namespace {

const std::string glow_on_sky =
    "skyfunc glow sky_glow 0 0 4 1 1 1 0\nsky_glow source sky 0 0 4 0 0 1 180\n";

/// ∫ L cosθ over what lies above the ground, of a picture of all directions: bilinear between its
/// nodes.
double horizontal_irradiance(const Object& picture) {
  const auto values = rad_numbers(picture, "data");
  const auto& extents = value<std::shared_ptr<const Array>>(picture, "data")->extents();
  const size_t rows = extents[0], columns = extents[1];
  double sum = 0;
  constexpr size_t fine = 16;
  for (size_t i = 0; i < (rows / 2) * fine; ++i) {
    const double row = (double(i) + 0.5) / fine, angle = pi_d * row / double(rows - 1);
    const auto low = size_t(row);
    const double share = row - double(low);
    for (size_t c = 0; c < columns; ++c) {
      const double value = (1 - share) * values[3 * (low * columns + c)] +
                           share * values[3 * ((low + 1) * columns + c)];
      sum += value * std::cos(angle) * std::sin(angle);
    }
  }
  return sum * pi_d / double(rows - 1) / fine * 2 * pi_d / double(columns);
}

/// In the direction, which must be that of a node.
double radiance_toward(const Object& picture, const Vec3d& direction) {
  const auto values = rad_numbers(picture, "data");
  const auto& extents = value<std::shared_ptr<const Array>>(picture, "data")->extents();
  const Vec3f local = value<Transform>(picture, "to_world").inverse().vector(Vec3f(direction));
  double turn = std::atan2(double(local.x), -double(local.z)) / (2 * pi_d);
  if (turn < 0) turn += 1;
  const auto row = size_t(std::lround(std::acos(double(local.y)) / pi_d * double(extents[0] - 1)));
  const auto column = std::min(size_t(turn * double(extents[1])), extents[1] - 1);
  return values[3 * (row * extents[1] + column)];
}

TEST(RadianceSkies, OvercastSkiesAsTheCieHasThem) {
  // E = 7/9 π L of the zenith; near the horizon Radiance's sky passes over into the ground, which
  // is black here.
  const auto scene = parse_rad("!gensky 6 21 12 -c -b 10 -g 0\n" + glow_on_sky);
  const Object& sky = sole_object(scene, "emitter");
  EXPECT_EQ(sky.type, "envmap");
  const double closed = 7.0 / 9 * pi_d * 10, found = horizontal_irradiance(sky);
  EXPECT_NEAR(found / closed, 1, 0.012);
  EXPECT_LT(found, closed);
  double blended = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double z = (i + 0.5) / 100'000, up = std::pow(z + 1.01, 10);
    blended += 2 * pi_d * z * 10 * (1 + 2 * z) / 3 * up / (up + 1 / up) / 100'000;
  }
  EXPECT_NEAR(found / blended, 1, 1e-3);
  EXPECT_EQ(deviations_but_view(scene), 0u);
}

TEST(RadianceSkies, UniformSkiesByIrradiance) {
  const auto scene = parse_rad("!gensky 6 21 12 -u -B 100 -g 1\n" + glow_on_sky +
                               "sky_glow source ground 0 0 4 0 0 -1 180\n");
  EXPECT_NEAR(horizontal_irradiance(sole_object(scene, "emitter")), 100, 0.1);
}

// As its function has it: no sky has such a number.
TEST(RadianceSkies, UnknownSkiesAreUniform) {
  const auto scene =
      parse_rad("void brightfunc skyfunc 2 skybr skybright.cal 0 3 1e308 2 0\n" + glow_on_sky);
  EXPECT_NEAR(radiance_toward(sole_object(scene, "emitter"), {0, 0, 1}), 2, 1e-3);
}

TEST(RadianceSkies, ClearSkiesAndTheirSun) {
  const auto scene = parse_rad("!gensky -ang 40 -30 +s -b 20 -r 5e6\n" + glow_on_sky);
  const auto lights = rad_objects(scene, "emitter");
  ASSERT_EQ(lights.size(), 2u);
  const Object &sun = *lights[0], &sky = *lights[1];
  EXPECT_EQ(sun.type, "sun");
  const double disc = pi_d * std::pow(std::sin(0.25 * pi_d / 180), 2);
  expect_colour(sun, "irradiance", 5e6 * disc, 5e6 * disc, 5e6 * disc, 1e-6);
  const double h = 40 * pi_d / 180, a = -30 * pi_d / 180;
  const Vec3d to_sun(-std::sin(a) * std::cos(h), -std::cos(a) * std::cos(h), std::sin(h));
  EXPECT_NEAR((value<Vec3d>(sun, "sun_direction") - to_sun).length(), 0, 1e-9);
  // The sun stands in the south-east, where the sky is brighter; at the zenith it is as asked for.
  EXPECT_NEAR(radiance_toward(sky, {0, 0, 1}), 20, 0.5);
  const Vec3d beside = Vec3d(-to_sun.x, -to_sun.y, to_sun.z);
  EXPECT_GT(radiance_toward(sky, to_sun), 3 * radiance_toward(sky, beside));
}

TEST(RadianceSkies, TheSunByPlaceAndTime) {
  // At noon by the sun on the longest day in Berkeley it stands 75.6 degrees high in the south.
  const auto noon = parse_rad("!gensky 6 21 +12 -a 37.8\nvoid plastic a 0 0 5 1 1 1 0 0\n");
  const Vec3d at_noon = value<Vec3d>(*rad_objects(noon, "emitter").at(0), "sun_direction");
  EXPECT_NEAR(std::asin(at_noon.z) * 180 / pi_d, 90 - 37.8 + 23.45, 0.3);
  EXPECT_LT(at_noon.y, 0);
  const auto later = parse_rad("!gensky 6 21 +16 -a 37.8\n");
  EXPECT_LT(value<Vec3d>(*rad_objects(later, "emitter").at(0), "sun_direction").x, -0.5);  // west
  // An hour of the clock is 15 degrees of longitude.
  const auto east = parse_rad("!gensky 3 21 12:00CET -a 48 -o 0\n");
  const auto west = parse_rad("!gensky 3 21 13:00CET -a 48 -o 15\n");
  const auto place = [](const Description& d) {
    return value<Vec3d>(*rad_objects(d, "emitter").at(0), "sun_direction");
  };
  EXPECT_NEAR((place(east) - place(west)).length(), 0, 1e-9);
}

TEST(RadianceSkies, MeasuredLightComesBack) {
  // In lux: what is asked for is what arrives, but for the horizon.
  for (const char* light : {"-L 60000 15000", "-L 0 8000", "-L 20000 30000"}) {
    SCOPED_TRACE(light);
    const auto scene =
        parse_rad(std::string("!gendaylit -ang 45 10 ") + light + " -g 0\n" + glow_on_sky);
    const auto lights = rad_objects(scene, "emitter");
    const double asked = std::stod(std::string(light).substr(std::string(light).rfind(' ')));
    EXPECT_NEAR(179 * horizontal_irradiance(*lights.back()) / asked, 1, 0.03);
    if (lights.size() == 2) {
      EXPECT_NEAR(
          179 * colour_in(*lights[0], "irradiance")->g / std::stod(std::string(light).substr(3)), 1,
          1e-4);
    }
  }
}

TEST(RadianceSkies, EvenLightIsConstant) {
  const auto scene = parse_rad("void glow g 0 0 4 1 2 3 0\ng source all 0 0 4 0 0 1 360\n");
  EXPECT_EQ(sole_object(scene, "emitter").type, "constant");
  expect_colour(sole_object(scene, "emitter"), "radiance", 1, 2, 3);
}

TEST(RadianceSkies, HalvesAndTurns) {
  TemporaryFolder folder;
  folder.write("half.rad", "void glow g 0 0 4 1 1 1 0\ng source half 0 0 4 1 0 0 180\n");
  const auto scene = load_radiance(folder.write("a.rad", "!xform -rz 90 half.rad\n"));
  const Object& picture = sole_object(scene, "emitter");
  EXPECT_EQ(radiance_toward(picture, {0, 1, 0}), 1);
  EXPECT_EQ(radiance_toward(picture, {0, -1, 0}), 0);
  EXPECT_NEAR(horizontal_irradiance(picture), pi_d / 2, 0.01);
}

TEST(RadianceSkies, FunctionsOfTheDirection) {
  // L = z²: E = 2π ∫ z³ = π / 2.
  const auto scene = parse_rad(
      "void brightfunc f 2 'if(Dz, Dz*Dz, 0)' . 0 0\nf glow g 0 0 4 1 1 1 0\n"
      "g source sky 0 0 4 0 0 1 180\n");
  EXPECT_NEAR(horizontal_irradiance(sole_object(scene, "emitter")), pi_d / 2, 1e-3);
}

}  // namespace
}  // namespace kaustik::radiance_test
