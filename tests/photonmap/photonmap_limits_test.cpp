// The photon map integrator at its limits: hardly any photons, tiny pictures, trapped light, level
// limits, several specular rays.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string ball_room(const std::string& objects, int size = 8) {
  return camera("0, -0.8, 0", "0, 1, -0.2", 75, size) +
         sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) +
         sphere("0.1, 0.1, 0.6", 0.2, diffuse("0, 0, 0") + area_light("10, 10, 10")) + objects;
}
const std::string mirror_ball = sphere("-0.3, 0.2, -0.3", 0.25, mirror());

TEST(PhotonMapLimits, OnePhotonAndOnePixel) {
  const TestScene scene(ball_room(mirror_ball, 1));
  for (const int photons : {1, 2, 3}) {
    const Passes passes =
        render(scene, "photonmap", set("global_photons", photons) + set("caustic_photons", photons),
               {4, 1, 2});
    EXPECT_TRUE(std::isfinite(passes.mean({"indirect"}).mean())) << photons;
    EXPECT_TRUE(std::isfinite(passes.mean({"caustic"}).mean())) << photons;
  }
}

/// A lamp near the inside of a glass ball: a good part of its light is totally reflected for ever.
TEST(PhotonMapLimits, TrappedLightEnds) {
  const TestScene scene(
      camera("0, -0.8, 0", "0, 1, -0.2", 75, 4) +
      sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) + sphere("0, 0.2, 0", 0.5, glass()) +
      sphere("0, 0.2, 0.45", 0.02, diffuse("0, 0, 0") + area_light("1000, 1000, 1000")));
  const Passes passes = render(
      scene, "photonmap", set("global_photons", 5000) + set("caustic_photons", 5000), {2, 1, 2});
  EXPECT_GT(passes.mean({"caustic"}).mean(), 0);
}

TEST(PhotonMapLimits, ReradiateWithoutCausticPhotonsKeepsTheirLight) {
  const TestScene scene(ball_room(mirror_ball));
  const std::string parameters = set("caustic_photons", 0) + set("components", "indirect") +
                                 set("irradiance_cache", false) + set("global_photons", 20000);
  const auto mean = [&](bool reradiate) {
    return render(scene, "photonmap", parameters + set("reradiate", reradiate), {4, 1, 2})
        .mean({"indirect"})
        .mean();
  };
  EXPECT_EQ(mean(true), mean(false));  // the same random numbers: nothing may differ
}

TEST(PhotonMapLimits, SeveralSpecularRaysChangeOnlyTheNoise) {
  const TestScene scene(ball_room(sphere("-0.1, 0.3, -0.2", 0.4, ggx(0.3))));
  const auto specular = [&](int rays, double samples) {
    return render(scene, "photonmap",
                  set("specular_samples", rays) + set("global_photons", 20000) +
                      set("caustic_photons", 2000),
                  {samples})
        .values({"specular"});
  };
  expect_equal_means("specular_samples = 4",
                     Comparison::same_seed(specular(4, 128), specular(1, 256)));
}

TEST(PhotonMapLimits, LightLevels) {
  const TestScene scene(ball_room(mirror_ball));
  const auto mean = [&](const std::string& parameters, const std::string& component) {
    return render(scene, "photonmap",
                  set("global_photons", 20000) + set("caustic_photons", 20000) + parameters,
                  {4, 1, 2})
        .mean({component})
        .mean();
  };
  // One event: caustics by one reflection and indirect light by one bounce are left.
  EXPECT_GT(mean(set("max_light_level", 1), "caustic"), 0);
  EXPECT_LT(mean(set("max_light_level", 1), "indirect"), 0.99 * mean("", "indirect"));
}

TEST(PhotonMapLimits, LevelOfDetailAndLightSamplesKeepTheMean) {
  const TestScene scene(ball_room(mirror_ball));
  const auto values = [&](const std::string& parameters) {
    return render(scene, "photonmap",
                  set("global_photons", 20000) + set("caustic_photons", 20000) + parameters, {4})
        .values({"direct", "indirect"});
  };
  const std::vector<double> plain = values("");
  expect_equal_means("light_samples = 4",
                     Comparison::same_seed(values(set("light_samples", 4)), plain));
  // Fewer neighbours at the second level, which have another bias.
  expect_near_means("level_of_detail = exponential",
                    Comparison::same_seed(values(set("level_of_detail", "exponential")), plain),
                    0.01);
}

}  // namespace
}  // namespace kaustik
