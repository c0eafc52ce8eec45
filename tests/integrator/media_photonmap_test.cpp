// The volume photon map against closed forms and against the light tracer.

#include "kaustik/image/metrics.h"
#include "tests/integrator/media_scenes.h"

namespace kaustik {
namespace {

using namespace test;

/// Photon counts that leave hardly any bias.
std::string many_photons(int volume) {
  return set("volume_photons", volume) + set("volume_neighbors", 10);
}

class BeamEstimate : public testing::TestWithParam<double> {
 protected:
  BeamEstimate() : scene_(lamp_in_ball_scene(GetParam())) {}
  TestScene scene_;
};

/// Light scattered once, against the closed form.
TEST_P(BeamEstimate, OfSingleScattering) {
  const Passes passes =
      render(scene_, "photonmap", many_photons(20'000) + set("max_light_level", 0), {16});
  for (int channel = 0; channel < 3; ++channel)
    expect_near_means(
        fmt::format("photonmap, lamp in a ball, g = {}, {}", GetParam(), "RGB"[channel]),
        Comparison(passes.mean({"volume"}, beside_the_lamp, channel),
                   lamp_in_ball_beside(ball_sigma[channel], ball_albedo, GetParam())),
        0.01, 0.005);
}

/// Light scattered any number of times, against light paths that are splatted.
TEST_P(BeamEstimate, OfAllScatteringLong) {
  const Passes photons = render(scene_, "photonmap", many_photons(15'000), {12});
  const Passes light = render(scene_, "lighttracer", "", {600});
  expect_near_means(
      fmt::format("photonmap against lighttracer, all scattering, g = {}", GetParam()),
      Comparison(photons.mean({"volume"}, beside_the_lamp),
                 light.mean({"volume"}, beside_the_lamp)),
      0.01, 0.006);
}

INSTANTIATE_TEST_SUITE_P(Anisotropy, BeamEstimate, testing::Values(0.0, 0.3));

// Slow builds take too few samples to tell.
#ifndef KAUSTIK_SLOW_BUILD
/// The twin: a medium that scatters 5 % less is told apart.
TEST(BeamEstimateTwin, LessScatteringIsToldApart) {
  const TestScene scene(lamp_in_ball_scene(0, "0.76, 0.76, 0.76"));
  const Passes passes =
      render(scene, "photonmap", many_photons(20'000) + set("max_light_level", 0), {16});
  const Comparison c(passes.mean({"volume"}, beside_the_lamp),
                     lamp_in_ball_beside(ball_sigma[1], ball_albedo, 0));
  EXPECT_LT(c.p_value_of_nearness(0.01), nearness_level());
}
#endif

/// The same bits for any number of threads.
TEST(HazyRoomPhotonMap, IsTheSameForAnyNumberOfThreads) {
  const TestScene scene(hazy_room());
  const std::string parameters = many_photons(5'000) + set("global_photons", 5'000);
  for (const std::string type : {"path", "lighttracer", "photonmap"}) {
    const std::string given = type == "photonmap" ? parameters : "";
    const Passes one = render(scene, type, given, {4, 1, 1, 1});
    const Passes many = render(scene, type, given, {4, 1, 1, 4});
    EXPECT_EQ(compare_images(one.images()[0], many.images()[0]).mse, 0) << type;
  }
}

}  // namespace
}  // namespace kaustik
