// Scenes of Radiance as they are rendered: units by closed forms, and a room beside its twin in
// Mitsuba's XML.

#include <numbers>

#include "kaustik/loader/radiance/radiance_scene.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

const double pi_d = std::numbers::pi;

/// The scene as a meter at the point sees it, its normal upward.
Description measured_at(const std::string& text, const Vec3d& point) {
  Description description = parse_radiance(text, "test.rad", "", {});
  std::erase_if(description.scene->children,
                [](const Child& child) { return child.object->family == "sensor"; });
  const auto meter = std::make_shared<Object>();
  meter->family = "sensor";
  meter->type = "irradiancepoints";
  meter->properties = {{"to_world", Transform::translate(point), {}}};
  description.scene->children.push_back({"", meter});
  return description;
}

/// W/m², of green; the twin of the check, an irradiance that is 2 % off, has to fail.
void expect_irradiance(const std::string& what, const std::string& text, double expected,
                       const Vec3d& point = {0, 0, 0}, double samples = 400) {
  SCOPED_TRACE(what);
  const TestScene scene(measured_at(text, point));
  const Passes passes = render(scene, "path", "", {samples});
  const auto found = passes.mean({""});
  if (found.standard_error() < 1e-6 * expected) {
    EXPECT_NEAR(found.mean() / expected, 1, 1e-3);
    return;
  }
  const Comparison comparison(found, expected);
  EXPECT_LT(comparison.relative_error(), 0.004);
  EXPECT_GT(comparison.p_value_of_nearness(0.002), check_level()) << found.mean();
  // Of few passes little is sure.
  EXPECT_LT(Comparison(found, 1.02 * expected).p_value_of_equality(),
            slow_build ? 0.01 : check_level());
}

// A square of 2 s on its side, h above: 4 times the form factor of a quarter.
TEST(RadianceUnits, UnderALight) {
  const double s = 0.5, h = 2, x = s / h, r = std::sqrt(1 + x * x);
  const double quarter = 2 * x / r * std::atan(x / r) / (2 * pi_d);
  expect_irradiance("light",
                    "void light l 0 0 3 10 10 10\n"
                    "l polygon p 0 0 12 -.5 -.5 2 -.5 .5 2 .5 .5 2 .5 -.5 2\n",
                    10 * pi_d * 4 * quarter);
  // Its back is dark.
  const TestScene behind(
      measured_at("void light l 0 0 3 10 10 10\n"
                  "l polygon p 0 0 12 -.5 -.5 2 .5 -.5 2 .5 .5 2 -.5 .5 2\n",
                  {0, 0, 0}));
  EXPECT_EQ(render(behind, "path", "", {16}).mean({""}).mean(), 0);
}

// E = L A cos θ / d² for a small disk: within its cone of 20 degrees, and nothing beside it.
TEST(RadianceUnits, UnderASpotlight) {
  const std::string spot =
      "void spotlight s 0 0 7 5000 5000 5000 40 0 0 -1\ns ring r 0 0 8 0 0 2 0 0 -1 0 .05\n";
  const double d = 2 - 1e-3 * std::sqrt(pi_d) * .05;
  expect_irradiance("spotlight", spot, 5000 * pi_d * .0025 / (d * d));
  const TestScene beside(measured_at(spot, {0.8, 0, 0}));  // 21.8 degrees
  EXPECT_EQ(render(beside, "path", "", {16}).mean({""}).mean(), 0);
}

// A small square whose radiance goes with the cube of the cosine, as luminaires of ies2rad shine by
// a table: I = L cos³θ · A cosθ.
TEST(RadianceUnits, UnderALuminaire) {
  const std::string luminaire =
      "void brightfunc lobe 2 Dz*Dz*Dz . 0 0\nlobe light l 0 0 3 900 900 900\n"
      "l polygon p 0 0 12 -.05 -.05 2 -.05 .05 2 .05 .05 2 .05 -.05 2\n";
  const double d = 2 - 1e-4;
  expect_irradiance("below", luminaire, 900 * .01 / (d * d));
  // 45° beside it.
  expect_irradiance("beside", luminaire, 900 * .01 * std::pow(.5, 2.5) / (2 * d * d), {2, 0, 0});
}

// E = π L (r / d)² below a ball.
TEST(RadianceUnits, UnderAGlow) {
  expect_irradiance("glow", "void glow g 0 0 4 20 20 20 0\ng sphere s 0 0 4 0 0 3 .5\n",
                    pi_d * 20 * (.5 / 3) * (.5 / 3));
}

// E = L π sin²(α/2) sin h.
TEST(RadianceUnits, UnderTheSun) {
  const double half = 0.25 * pi_d / 180;
  expect_irradiance("sun", "void light solar 0 0 3 1e6 1e6 1e6\nsolar source sun 0 0 4 0 1 1 .5\n",
                    1e6 * pi_d * std::sin(half) * std::sin(half) * std::sqrt(.5));
}

// E = 7/9 π L of the zenith, but for 0.6 % that the sky lacks near the horizon.
TEST(RadianceUnits, UnderAnOvercastSky) {
  double blended = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double z = (i + 0.5) / 10'000, up = std::pow(z + 1.01, 10);
    blended += 2 * pi_d * z * 10 * (1 + 2 * z) / 3 * up / (up + 1 / up) / 10'000;
  }
  EXPECT_NEAR(blended / (7.0 / 9 * pi_d * 10), 1, 0.01);
  expect_irradiance("overcast sky",
                    "!gensky 6 21 12 -c -b 10 -g 0\nskyfunc glow g 0 0 4 1 1 1 0\n"
                    "g source sky 0 0 4 0 0 1 180\n",
                    blended);
}

TEST(RadianceTwins, ARoomAndItsTwinLookAlike) {
  const std::string folder = std::string(KAUSTIK_SOURCE_DIR) + "/tests/loader/twins/radiance/";
  const Description ours = load_radiance(folder + "room.rif"),
                    theirs = load_mitsuba_xml(folder + "room.xml");
  EXPECT_TRUE(ours.deviations.empty()) << ours.deviations[0].what;
  const Passes a = render(TestScene(ours), "path", "", {24}),
               b = render(TestScene(theirs), "path", "", {24});
  ASSERT_EQ(a.images()[0].width(), b.images()[0].width());
  ASSERT_EQ(a.images()[0].height(), b.images()[0].height());
  for (const int channel : {0, 1, 2})
    for (int block = 0; block < 6; ++block) {
      const auto within = [&](int x, int y) {
        return x / 8 == block % 3 && y / 8 == block / 3 ? 1.0 : 0.0;
      };
      const auto of_a = a.mean({""}, within, channel), of_b = b.mean({""}, within, channel);
      EXPECT_GT(Comparison(of_a, of_b).p_value_of_equality(), check_level())
          << "channel " << channel << " block " << block << ": " << of_a.mean() << " and "
          << of_b.mean();
    }
}

}  // namespace
}  // namespace kaustik
