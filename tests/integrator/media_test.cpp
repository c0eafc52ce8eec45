// Light in media against closed forms, and the methods against one another.

#include "tests/integrator/media_scenes.h"

namespace kaustik {
namespace {

using namespace test;

// ---------------------------------------------------------------- transmittance

/// Light that crosses a ball of haze without being scattered: exp(−σ 2r) of it. Only rays near the
/// axis are seen, whose way through the ball is shorter by 2e-5.
TEST(Transmittance, OfALampBehindAnAbsorbingBall) {
  const double sigma[] = {0.3, 0.6, 1.0};
  const TestScene scene(
      camera("0, 0, 6", "0, 0, 0", 0.1, 4, "0, 1, 0") +
      sphere("0, 0, 0", 1, null_bsdf + medium("interior", "0.3, 0.6, 1", "0, 0, 0")) +
      flat("rectangle", scale("0.1") + translate("0, 0, -3"),
           diffuse("0, 0, 0") + area_light("2, 2, 2")));
  for (const std::string type : {"path", "photonmap"}) {
    const Passes passes = render(scene, type, "", {type == "path" ? 1024.0 : 16.0});
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(
          passes.mean({"emission"}, {}, channel).mean() / (2 * std::exp(-2 * sigma[channel])), 1,
          type == "path" ? 0.01 : 1e-4)
          << type << " "
          << "RGB"[channel];
  }
}

/// A point light above a matt floor, all in an absorbing medium around the camera: exp(−σ(1 + 3))
/// of what there would be in a vacuum, for pixels near the light's foot.
TEST(Transmittance, OfDirectLightAndOfTheViewTogether) {
  const std::string rest =
      flat("rectangle", scale("5"), diffuse("0.5, 0.5, 0.5")) + point_light("0, 0, 1", 1);
  const std::string view = camera("0, 0, 3", "0, 0, 0", 2, 4, "0, 1, 0");
  const TestScene scene(camera_in(medium("", "0.4, 0.4, 0.4", "0, 0, 0"), view) + rest);
  const double expected = 0.5 / std::numbers::pi * std::exp(-0.4 * (1 + 3));
  // A pixel at the edge is up to 0.07 away from the foot, which makes 1 % less light.
  const double in_vacuum = render(TestScene(view + rest), "path", "", {64}).mean({"direct"}).mean();
  EXPECT_NEAR(in_vacuum, 0.5 / std::numbers::pi, 0.01 * in_vacuum);
  for (const std::string type : {"path", "lighttracer", "photonmap"}) {
    const Passes passes = render(scene, type, "", {type == "lighttracer" ? 20'000.0 : 512.0});
    EXPECT_NEAR(passes.mean({"direct"}).mean() / expected, 1, type == "lighttracer" ? 0.1 : 0.01)
        << type;
  }
}

// ---------------------------------------------------------------- furnace

/// Nothing is absorbed and everything around shines alike: so does the medium, whatever it
/// scatters where.
class WhiteFurnace : public testing::TestWithParam<double> {
 protected:
  static std::string text(const std::string& albedo) {
    return camera("0, 0, 5", "0, 0, 0", 20, 8, "0, 1, 0") +
           sphere("0, 0, 0", 1, null_bsdf + medium("interior", "0.5, 1, 2", albedo, GetParam())) +
           constant_light(1);
  }
};

TEST_P(WhiteFurnace, IsOneEverywhere) {
  const Passes passes = render(TestScene(text("1, 1, 1")), "path", "", {400});
  for (int channel = 0; channel < 3; ++channel)
    expect_mean(fmt::format("white furnace, g = {}, {}", GetParam(), "RGB"[channel]),
                passes.mean({""}, {}, channel), 1);
}

/// So it does by paths from both ends, in the channels whose noise is low.
TEST_P(WhiteFurnace, IsOneFromBothEnds) {
  const TestScene scene(text("1, 1, 1"));
  for (const char* type : {"bdpt", "vcm", "ppm", "auto"}) {
    const Passes passes = render(scene, type, "", {80});
    for (int channel = 0; channel < 2; ++channel)
      expect_mean(fmt::format("{}, white furnace, g = {}, {}", type, GetParam(), "RGB"[channel]),
                  passes.mean({""}, {}, channel), 1);
  }
}

// Slow builds take too few samples to tell.
#ifndef KAUSTIK_SLOW_BUILD
/// What is absorbed is missing: the twin that must fail.
TEST_P(WhiteFurnace, FailsWhereALittleIsAbsorbed) {
  const Passes passes = render(TestScene(text("0.97, 0.97, 0.97")), "path", "", {96});
  const Comparison c(passes.mean({""}), 1);
  EXPECT_LT(c.p_value_of_equality(), check_level());
}
#endif

INSTANTIATE_TEST_SUITE_P(Anisotropy, WhiteFurnace, testing::Values(0.0, 0.7, -0.4));

// ---------------------------------------------------------------- single scattering

/// The quadrature is right to 1e-6: twice the steps give the same.
TEST(Airlight, QuadratureHasConverged) {
  for (const double g : {0.0, 0.6})
    EXPECT_NEAR(airlight(0.6, 0.8, g, 0.5) / airlight(0.6, 0.8, g, 0.5, 8000), 1, 1e-6);
}

class EveryAirlight : public testing::TestWithParam<double> {
 protected:
  EveryAirlight() : scene_(airlight_scene(GetParam())) {}

  void check(const std::string& type, const Passes& passes) {
    for (int channel = 0; channel < 3; ++channel)
      expect_mean(
          fmt::format("{} airlight, g = {}, {}", type, GetParam(), "RGB"[channel]),
          passes.mean({"volume"}, {}, channel),
          airlight(airlight_sigma[channel], airlight_albedo, GetParam(), airlight_distance));
  }
  TestScene scene_;
};

TEST_P(EveryAirlight, Path) { check("path", render(scene_, "path", set("max_depth", 2), {1500})); }
INSTANTIATE_TEST_SUITE_P(Anisotropy, EveryAirlight, testing::Values(0.0, 0.6));

class EveryLampInABall : public testing::TestWithParam<double> {
 protected:
  EveryLampInABall() : scene_(lamp_in_ball_scene(GetParam())) {}

  void check(const std::string& type, const std::string& parameters, double samples) {
    const Passes passes = render(scene_, type, parameters, {samples});
    for (int channel = 0; channel < 3; ++channel)
      expect_mean(fmt::format("{}, lamp in a ball, g = {}, {}", type, GetParam(), "RGB"[channel]),
                  passes.mean({"volume"}, {}, channel),
                  lamp_in_ball(ball_sigma[channel], ball_albedo, GetParam(), ball_eye, ball_fov));
  }
  TestScene scene_;
};

TEST(LampInABall, QuadratureHasConverged) {
  for (const double g : {0.0, 0.6})
    EXPECT_NEAR(lamp_in_ball(0.8, 0.8, g, ball_eye, ball_fov) /
                    lamp_in_ball(0.8, 0.8, g, ball_eye, ball_fov, 800),
                1, 1e-6);
}

TEST_P(EveryLampInABall, LightTracer) { check("lighttracer", set("max_depth", 2), 300); }

INSTANTIATE_TEST_SUITE_P(Anisotropy, EveryLampInABall, testing::Values(0.0, 0.6));

// Slow builds take too few samples to tell.
#ifndef KAUSTIK_SLOW_BUILD
/// The twin: haze that scatters 3 % less.
TEST(LampInABallTwin, LessScatteringIsToldApart) {
  const TestScene scene(lamp_in_ball_scene(0, "0.776, 0.776, 0.776"));
  const Passes passes = render(scene, "lighttracer", set("max_depth", 2), {300});
  const Comparison c(passes.mean({"volume"}),
                     lamp_in_ball(ball_sigma[1], ball_albedo, 0, ball_eye, ball_fov));
  EXPECT_LT(c.p_value_of_equality(), check_level());
}
#endif

// ---------------------------------------------------------------- all components

/// The camera stands outside: points of a medium close to it would make the light tracer's noise
/// infinite.
TEST(HazyBall, PathAndLightTracerAgree) {
  const TestScene scene(hazy_ball());
  EXPECT_TRUE(scene.scene().warnings().empty());
  const Passes path = render(scene, "path", "", {1500});
  const Passes light = render(scene, "lighttracer", "", {2500});
  for (const std::string component : {"direct", "volume"})
    for (const int channel : {0, 2})
      expect_equal_means(
          fmt::format("hazy ball, {} {}", component, "RGB"[channel]),
          Comparison(light.mean({component}, {}, channel), path.mean({component}, {}, channel)),
          0.005);
}

// Slow builds take too few samples to tell.
#ifndef KAUSTIK_SLOW_BUILD
/// The twin: a ball that scatters 3 % less is told apart.
TEST(HazyBall, LightTracerIsToldFromALessScatteringBall) {
  const Passes path = render(TestScene(hazy_ball("0.873, 0.776, 0.679")), "path", "", {400});
  const Passes light = render(TestScene(hazy_ball()), "lighttracer", "", {1200});
  const Comparison c(light.mean({"volume"}), path.mean({"volume"}));
  EXPECT_LT(c.p_value_of_equality(), check_level());
}
#endif

TEST(HazyRoom, ComponentsSumToThePicture) {
  const TestScene scene(hazy_room());
  const Passes passes = render(scene, "path", "", {8, 1, 1});
  const std::vector<std::string> names(component_names.begin(), component_names.end());
  EXPECT_NEAR(passes.values(names)[0], passes.values({""})[0], 1e-5);
}

}  // namespace
}  // namespace kaustik
