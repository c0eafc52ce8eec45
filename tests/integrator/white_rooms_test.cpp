// Light that takes many events to be absorbed, against closed forms: white rooms, and a white ball
// under skins of glass, where its paths leave clusters of photons.

#include "kaustik/transport/roulette.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr double lamp_radius = 0.1;

/// A round room with a black lamp in its middle, seen from beside the lamp.
TestScene white_room(double reflectance) {
  return TestScene(camera("0, -0.5, 0", "0, -1, 0", 60, 8) +
                   sphere("0, 0, 0", 1, diffuse(fmt::format("{}", reflectance)), true) +
                   sphere("0, 0, 0", lamp_radius, diffuse("0") + area_light("1")));
}
/// All of its wall is lit alike: of what a point sends out the share lamp_radius² meets the lamp,
/// the rest the wall.
double radiance_of_room(double reflectance) {
  const double of_lamp = lamp_radius * lamp_radius;  // over π
  return reflectance * of_lamp / (1 - reflectance * (1 - of_lamp));
}

/// Not told from what is right, but well from what the old rule left of it in such rooms.
void expect_told_from(double share, const std::string& what, const RunningStatistics& found,
                      double expected) {
  const Comparison c(found, expected);
  EXPECT_GT(c.p_value_of_equality(), check_level()) << what << ": ratio " << c.ratio();
  if (slow_build) return;
  EXPECT_LT(c.p_value_of_equality(1 / share), check_level()) << what << ": ratio " << c.ratio();
}

TEST(WhiteRooms, HaveTheRightRadiance) {
  for (const double reflectance : {0.9, 0.99, 1.0})
    expect_told_from(
        0.9, fmt::format("walls of {}", reflectance),
        render(white_room(reflectance), "photonmap", set("global_photons", 2000), {16}).mean({""}),
        radiance_of_room(reflectance));
}

/// Weights of survivors by the old rule, a chance of 0.95 for every event after 16, against those
/// by this one: the second moment of what paths bring in a room of 0.99.
TEST(Roulette, LeavesTheVarianceFinite) {
  const auto moments = [](auto chance) {
    double alive = 1, weight = 1, first = 0, second = 0;
    for (int n = 0; n < 4000; ++n) {
      alive *= chance(n), weight *= 0.99 / chance(n);
      first += alive * weight, second += alive * weight * weight;
    }
    return std::pair(first, second);
  };
  const auto [mean, square] =
      moments([](int n) { return std::min(0.99, double(length_survival(n))); });
  EXPECT_NEAR(mean, 99, 0.01);
  EXPECT_LT(square, 5 * mean);
  EXPECT_GT(moments([](int n) { return n < 16 ? 0.99 : 0.95; }).second, 1e6);
}
TEST(Roulette, EndsWhatNothingAbsorbs) {
  double alive = 1, events = 0;
  for (int n = 0; n < 1'000'000; ++n) events += alive *= double(length_survival(n));
  EXPECT_NEAR(events, 2 * certain_events, 1);
}

/// A white ball in a white world: as bright as that, whatever glass is about it.
void expect_white(const std::string& name, const std::string& skins) {
  const TestScene scene(camera("0, -4, 0", "0, 0, 0", 20, 8) + constant_light(1) +
                        sphere("0, 0, 0", 1, diffuse("1")) + skins);
  expect_told_from(1.12, name,
                   render(scene, "photonmap",
                          set("global_photons", 40'000) + set("caustic_photons", 40'000), {4})
                       .mean({""}),
                   1);
}
std::string skin(double radius, double inner_ior = 1.5, double outer_ior = 1) {
  return sphere("0, 0, 0", radius,
                fmt::format(R"(<bsdf type="dielectric"><float name="int_ior" value="{}"/>
                <float name="ext_ior" value="{}"/></bsdf>)",
                            inner_ior, outer_ior));
}

TEST(GlassSkin, IsAsBrightAsTheWorld) {
  expect_white("thin", skin(1.0001));
  expect_white("thick", skin(1.02));
  expect_white("two", skin(1.0001, 1.8, 1.4) + skin(1.0002, 1.4));
}

}  // namespace
}  // namespace kaustik
