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

TEST(WhiteRooms, HaveTheRightRadiance) {
  for (const double reflectance : {0.9, 0.99, 1.0}) {
    const TestScene scene = white_room(reflectance);
    const double expected = radiance_of_room(reflectance);
    expect_near_means(
        fmt::format("photonmap, walls of {}", reflectance),
        {render(scene, "photonmap", set("global_photons", 6000), {16}).mean({""}), expected}, 0.01);
  }
}
/// The variance of their estimates is finite as well.
TEST(WhiteRooms, AreFoundByPaths) {
  const TestScene scene = white_room(0.99);
  for (const char* integrator : {"path", "lighttracer"})
    expect_equal_means(
        integrator,
        {render(scene, integrator, set("components", "indirect"), {24}).mean({"indirect"}),
         radiance_of_room(0.99) - 0.99 * lamp_radius * lamp_radius});
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
double under_glass(const std::string& skins, const std::string& parameters = "") {
  const TestScene scene(camera("0, -4, 0", "0, 0, 0", 20, 8) + constant_light(1) +
                        sphere("0, 0, 0", 1, diffuse("1")) + skins);
  return render(scene, "photonmap",
                set("global_photons", int(40'000 * sample_share)) +
                    set("caustic_photons", int(40'000 * sample_share)) + parameters,
                {16, 1, 4})
      .mean({""})
      .mean();
}
std::string skin(double radius, double inner_ior = 1.5, double outer_ior = 1) {
  return sphere("0, 0, 0", radius,
                fmt::format(R"(<bsdf type="dielectric"><float name="int_ior" value="{}"/>
                <float name="ext_ior" value="{}"/></bsdf>)",
                            inner_ior, outer_ior));
}

TEST(GlassSkin, IsAsBrightAsTheWorld) {
  const double tolerance = slow_build ? 0.05 : 0.015;
  EXPECT_NEAR(under_glass(skin(1.0001)), 1, tolerance);
  EXPECT_NEAR(under_glass(skin(1.02)), 1, tolerance);
  EXPECT_NEAR(under_glass(skin(1.0001, 1.8, 1.4) + skin(1.0002, 1.4)), 1, tolerance);
}

}  // namespace
}  // namespace kaustik
