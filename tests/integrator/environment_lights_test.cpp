// Light from around the scene through the integrators: all of them find the same.

#include "kaustik/image/image_io.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

std::string background(double radiance) {
  return fmt::format(R"(<emitter type="background"><rgb name="radiance" value="{}"/></emitter>)",
                     radiance);
}
std::string sunsky(const std::string& to_sun, double aperture) {
  return fmt::format(
      R"(<emitter type="sunsky"><vector name="sun_direction" value="{}"/>
      <float name="sun_aperture" value="{}"/><float name="sky_scale" value="0.01"/>
      <float name="sun_scale" value="0.01"/></emitter>)",
      to_sun, aperture);
}

TEST(Background, IsSeenPastTheSceneAndInMirrorsButLightsNothing) {
  const std::string view = camera("0, 0, 4", "0, 0, 0", 20, 8, "0, 1, 0");
  const std::string past = view + flat("disk", translate("9, 0, 0"), diffuse("1, 1, 1"));
  const std::string mirrored = view + flat("disk", scale("9, 9, 1"), mirror());
  const std::string lit = view + flat("disk", scale("9, 9, 1"), diffuse("0.5, 0.5, 0.5"));
  const std::string glazed = past + flat("disk", scale("9, 9, 1"), glass(1.0));
  for (const char* integrator : {"path", "photonmap"}) {
    const auto seen = [&](const std::string& scene) {
      RenderOptions options;
      options.samples = 4;
      options.passes = 2;
      return render(TestScene(scene + background(3)), integrator, "", options).mean({""}).mean();
    };
    EXPECT_NEAR(seen(past), 3, 1e-5) << integrator;
    EXPECT_NEAR(seen(mirrored), 3, 1e-4) << integrator;
    EXPECT_NEAR(seen(glazed), 3, 1e-4) << integrator;
    EXPECT_EQ(seen(lit), 0) << integrator;
  }
}

/// A convex diffuse thing that is lit alike from everywhere sends back its albedo's share.
TEST(Envmap, OfOneColorLightsAsAFurnace) {
  const TemporaryFolder folder;
  const std::string path = folder.path("grey.exr");
  Image image(16, 8, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c)
    for (float& value : image.channel(c)) value = 2;
  write_image(image, path);
  const TestScene scene(
      camera("0, -4, 0", "0, 0, 0", 10, 8) + sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5")) +
      R"(<emitter type="envmap"><string name="filename" value=")" + path + R"("/></emitter>)");
  expect_mean("furnace by path", render(scene, "path", "", {256, 2}).mean({""}), 1.0);
}

/// A room without its right wall under sun and sky. The sun is wide, so that all meet it often.
std::string open_room() {
  const std::string grey = diffuse("0.5, 0.5, 0.5");
  const auto wall = [&](const std::string& place) { return flat("rectangle", place, grey); };
  return camera("0, -0.9, 0", "0, 1, 0", 80, 6) + wall(translate("0, 0, -1")) +
         wall(rotate("1, 0, 0", 180) + translate("0, 0, 1")) +
         wall(rotate("1, 0, 0", 90) + translate("0, 1, 0")) +
         wall(rotate("1, 0, 0", -90) + translate("0, -1, 0")) +
         wall(rotate("0, 1, 0", 90) + translate("-1, 0, 0")) + sunsky("1, 0.1, 0.5", 40);
}

TEST(SunSky, LightsARoomAlikeByPathsPhotonsAndLightTracing) {
  const TestScene scene(open_room());
  const auto by_path = render(scene, "path", "", {1000, 2});
  const auto by_light = render(scene, "lighttracer", "", {4000, 4});
  const RunningStatistics by_photons =
      render(scene, "photonmap",
             set("components", "indirect") + set("global_photons", 60'000) +
                 set("global_neighbors", 12) + set("irradiance_cache", false),
             {80, 3})
          .mean({"indirect"});
  for (const char* part : {"direct", "indirect"})
    expect_equal_means(fmt::format("{}, light tracing", part),
                       Comparison(by_light.mean({part}), by_path.mean({part})), 0.004);
  expect_near_means("indirect, photon map", Comparison(by_photons, by_path.mean({"indirect"})),
                    0.01, 0.006);
}

/// A ball that nothing meets lights a floor as a lamp of the same size does, which also is one for
/// rays: by paths that ask for light, and by emitted photons.
TEST(DistributedLight, LightsAsALampOfItsSize) {
  const std::string floor = camera("0, -3, 2", "0, 0, 0", 40, 6) +
                            flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5"));
  const std::string ball =
      R"(<emitter type="distributed"><point name="position" value="0.3, 0, 1.5"/>
      <float name="radius" value="0.4"/><rgb name="intensity" value="2"/></emitter>)";
  const double radiance = 2 / (std::numbers::pi * 0.16);
  const std::string lamp =
      sphere("0.3, 0, 1.5", 0.4, diffuse("0, 0, 0") + area_light(fmt::format("{}", radiance)));
  const auto mean = [](const std::string& scene, const char* integrator, double samples) {
    return render(TestScene(scene), integrator, "", {samples, 5}).mean({"direct"});
  };
  const RunningStatistics by_lamp = mean(floor + lamp, "path", 600);
  expect_equal_means("ball, by paths", mean(floor + ball, "path", 300), by_lamp);
  expect_equal_means("ball, by light tracing", mean(floor + ball, "lighttracer", 3000), by_lamp);
}

}  // namespace
}  // namespace kaustik
