// Media that scatter, by paths from both ends, against closed forms and the other methods.

#include "kaustik/image/metrics.h"
#include "tests/integrator/media_scenes.h"

namespace kaustik {
namespace {

using namespace test;

/// Light scattered once. The picture is so narrow that nothing merges: discs are of its pixels.
TEST(VcmInMedia, Airlight) {
  for (const double g : {0.0, 0.6}) {
    const TestScene scene(airlight_scene(g));
    for (const char* type : {"vcm", "bdpt", "ppm", "auto"}) {
      const Passes passes = render(scene, type, set("max_depth", 2), {1200});
      for (int channel = 0; channel < 3; ++channel)
        expect_mean(fmt::format("{} airlight, g = {}, {}", type, g, "RGB"[channel]),
                    passes.mean({"volume"}, {}, channel),
                    airlight(airlight_sigma[channel], airlight_albedo, g, airlight_distance));
    }
  }
}

#ifndef KAUSTIK_SLOW_BUILD
/// The twin: 3 % less light is told apart.
TEST(VcmInMedia, AirlightTwin) {
  const TestScene scene(airlight_scene(0));
  const Passes passes = render(scene, "vcm", set("max_depth", 2), {1200});
  const Comparison c(passes.mean({"volume"}),
                     0.97 * airlight(airlight_sigma[1], airlight_albedo, 0, airlight_distance));
  EXPECT_LT(c.p_value_of_equality(), check_level());
}
#endif

/// All of a room of fog, seen from within, with a ball of glass and one of coloured fog.
TEST(VcmInMedia, HazyRoomLong) {
  const TestScene scene(hazy_room());
  const Passes path = render(scene, "path", "", {1600, 7});
  const Passes connected = render(scene, "bdpt", "", {500, 8});
  for (int channel = 0; channel < 3; ++channel)
    expect_near_means(fmt::format("bdpt, hazy room, volume {}", "RGB"[channel]),
                      connected.mean({"volume"}, {}, channel), path.mean({"volume"}, {}, channel),
                      0.005);
  expect_near_means("bdpt, hazy room, direct", connected.mean({"direct"}), path.mean({"direct"}),
                    0.005);
  for (const char* type : {"vcm", "ppm"}) {
    const Passes merged =
        render(scene, type, set("radius", 0.03) + set("light_paths", 4.0), {400, 8});
    expect_near_means(fmt::format("{}, hazy room, volume", type), merged.mean({"volume"}),
                      path.mean({"volume"}), 0.01);
  }
  const Passes chosen = render(scene, "auto", "", {900, 8});
  expect_near_means("auto, hazy room", chosen.mean({"volume"}), path.mean({"volume"}), 0.01);
}

/// A point lamp through a ball of glass into a ball of fog: the caustic hangs in the air, where no
/// path from the camera finds it.
TEST(VcmInMedia, CausticInTheAirLong) {
  const auto named = [&](const std::string& name) {
    return medium(name, "0.4, 0.6, 0.8", "0.9, 0.8, 0.7", 0.3);
  };
  const TestScene scene(
      camera("0, -4, 0.2", "0, 0, 0", 35, 8) + sphere("0, 0, 0", 1, null_bsdf + named("interior")) +
      sphere("0, 0, 0.4", 0.4, glass() + named("exterior")) + point_light("0.3, 0, 2.5", 3));
  const Passes light = render(scene, "lighttracer", "", {7000, 7});
  for (const char* type : {"ppm", "vcm", "auto"}) {
    const std::string parameters =
        type == std::string("auto") ? "" : set("radius", 0.02) + set("light_paths", 4.0);
    const Passes found = render(scene, type, parameters, {550, 8});
    expect_near_means(fmt::format("{}, caustic in the air", type), found.mean({"volume"}),
                      light.mean({"volume"}), 0.01);
  }
}

/// A ball of fog whose mean free path is far less than a pixel: discs as wide as pixels would reach
/// out of it, and make it a third darker.
TEST(VcmInMedia, DenseFogLong) {
  const TestScene scene(
      camera("0, -3, 0", "0, 0, 0", 40, 16) +
      sphere("0, 0, 0", 1, null_bsdf + medium("interior", "100, 100, 100", "0.9, 0.9, 0.9", 0)) +
      point_light("0, 0, 3", 10));
  const Passes path = render(scene, "path", "", {700, 7});
  for (const char* type : {"ppm", "auto"})
    expect_near_means(fmt::format("{}, dense fog", type),
                      render(scene, type, "", {400, 8}).mean({"volume"}), path.mean({"volume"}),
                      0.01);
}

/// The same bits for any number of threads.
TEST(VcmInMedia, IsTheSameForAnyNumberOfThreads) {
  const TestScene scene(hazy_room());
  for (const std::string type : {"vcm", "bdpt", "ppm", "auto"}) {
    const Passes one = render(scene, type, "", {4, 1, 3, 1});
    const Passes many = render(scene, type, "", {4, 1, 3, 4});
    for (size_t pass = 0; pass < one.images().size(); ++pass)
      EXPECT_EQ(compare_images(one.images()[pass], many.images()[pass]).mse, 0) << type;
  }
}

}  // namespace
}  // namespace kaustik
